// SPDX-License-Identifier: GPL-3.0-or-later
// Text in, messages out: helpers of the compiler's tests.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "msml/compile/compile.hpp"
#include "tests/compile/tiny_registry.hpp"

namespace msml::tiny {

/// A folder that lives as long as the object.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "msml_test_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Writes a file into the folder.
  void add(const std::string& name, const std::string& text = "x") const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      all.push_back(entry.path().filename().string());
    return all;
  }

 private:
  std::filesystem::path path_;
};

/// Compiles with the small language. The scene is called s.xml and stands in `folder` ("" = nowhere).
inline Compilation compiled(const std::string& text, CompileOptions options = {},
                            const std::filesystem::path& folder = {}) {
  static const Registry registry = tiny::registry();
  if (options.output_folder == ".") options.output_folder = folder.empty() ? "/nonexistent" : folder / "out";
  return compile_text(text, (folder / "s.xml").string(), registry, options);
}

/// "s.xml:3: message" lines, without the folder.
inline std::string lines(const std::vector<Fault>& faults) {
  std::string all;
  for (const Fault& fault : faults) {
    std::string line = fault.str();
    if (const auto at = line.find("s.xml"); line.starts_with("/") && at != std::string::npos) line = line.substr(at);
    all += (all.empty() ? "" : "\n") + line;
  }
  return all;
}

inline std::string faults_of(const std::string& text, const CompileOptions& options = {},
                             const std::filesystem::path& folder = {}) {
  return lines(compiled(text, options, folder).faults);
}

/// A scene of tasks; the first of them stands on line 2.
inline std::string workflow(const std::string& tasks) { return "<msml><workflow>\n" + tasks + "\n</workflow></msml>"; }

/// Faults of tasks, the first of them on line 2.
inline std::string task_faults(const std::string& tasks, const CompileOptions& options = {},
                               const std::filesystem::path& folder = {}) {
  return faults_of(workflow(tasks), options, folder);
}

/// A scene with one variable on line 2 and tasks from line 3 on.
inline std::string with_variables(const std::string& variables, const std::string& tasks) {
  return "<msml><variables>\n" + variables + "</variables><workflow>\n" + tasks + "\n</workflow></msml>";
}

}  // namespace msml::tiny
