// SPDX-License-Identifier: GPL-3.0-or-later
// Starts another program and waits for it.
#include "msml/run/program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace msml {
namespace {

/// What a program that is started does with its folder and its streams.
class Actions {
 public:
  explicit Actions(const std::filesystem::path& folder) {
    ::posix_spawn_file_actions_init(&actions_);
    if (!folder.empty()) ::posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  }
  ~Actions() { ::posix_spawn_file_actions_destroy(&actions_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  void silence(int stream) { ::posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_WRONLY, 0); }
  void redirect(int stream, int to) { ::posix_spawn_file_actions_adddup2(&actions_, to, stream); }

  /// The process, or -1.
  pid_t start(const std::vector<std::string>& words) const {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t child = -1;
    return ::posix_spawnp(&child, arguments[0], &actions_, nullptr, arguments.data(), environ) == 0 ? child : -1;
  }

 private:
  posix_spawn_file_actions_t actions_;
};

int exit_code(pid_t child) {
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status) == 127 ? -1 : WEXITSTATUS(status);
}

}  // namespace

int run_program(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  Actions actions(folder);
  actions.silence(STDOUT_FILENO);
  actions.silence(STDERR_FILENO);
  return exit_code(actions.start(words));
}

std::string program_output(const std::vector<std::string>& words) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  Actions actions({});
  actions.redirect(STDOUT_FILENO, ends[1]);
  actions.silence(STDERR_FILENO);
  const pid_t child = actions.start(words);
  ::close(ends[1]);
  std::string text;
  char part[256];
  for (ssize_t n = 0; (n = ::read(ends[0], part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(n));
  ::close(ends[0]);
  return exit_code(child) == 0 ? text.substr(0, text.find('\n')) : "";
}

}  // namespace msml
