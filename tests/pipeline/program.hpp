// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the msml program as a user does.
#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/content.hpp"

namespace msml::testing {

namespace fs = std::filesystem;

/// What a finished program left: exit code, standard output and standard error.
struct Finished {
  int code = -1;
  std::string out, err;
};

/// A folder of its own for one test, removed at the end.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "msml_pipeline_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

/// `msml ARGUMENTS` with a time limit of `seconds`; a program that hangs ends with code 124. `before`: what the shell
/// does first.
inline Finished run_msml(const std::string& arguments, int seconds = 240, const std::string& before = "") {
  const Folder folder;
  const std::string command = before + "timeout " + std::to_string(seconds) + " '" MSML_PROGRAM "' " + arguments +
                              " >'" + (folder / "out").string() + "' 2>'" + (folder / "err").string() + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out"), content(folder / "err")};
}

inline std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

/// The original scenes of the language, kept outside the project; tests skip where they are absent.
inline fs::path original_scenes() { return fs::path(MSML_SOURCE_DIR) / ".." / "shared" / "scenes"; }
/// Sample data that ./dev unpacks.
inline fs::path sample_data() { return fs::path(MSML_SOURCE_DIR) / "data"; }

}  // namespace msml::testing
