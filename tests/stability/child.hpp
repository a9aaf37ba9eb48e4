// SPDX-License-Identifier: GPL-3.0-or-later
// A program beside the test, read line by line, and ended where it says nothing for too long.
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <vector>

namespace msml::testing {

/// Starts the program; its end is that of this object, by force if need be.
class Child {
 public:
  explicit Child(const std::vector<std::string>& words) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (::posix_spawnp(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) pid_ = -1;
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    out_ = ends[0];
  }
  ~Child() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    if (out_ >= 0) ::close(out_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  enum class Told { line, end, nothing };
  /// The next line, the end of the program, or nothing within the given seconds.
  Told next(double seconds, std::string& line) {
    while (true) {
      if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
        line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return Told::line;
      }
      pollfd waits{out_, POLLIN, 0};
      if (::poll(&waits, 1, static_cast<int>(1000 * seconds)) <= 0) return Told::nothing;
      char part[4096];
      const ssize_t count = ::read(out_, part, sizeof part);
      if (count <= 0) return Told::end;
      text_.append(part, static_cast<std::size_t>(count));
    }
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  std::string text_;
};

}  // namespace msml::testing
