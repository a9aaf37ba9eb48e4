// SPDX-License-Identifier: GPL-3.0-or-later
// The project's own text files, read once so that rules about them can be tested.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace msml::repository {

/// One `#include` line.
struct Include {
  std::string name;     ///< what stands between the quotes or angle brackets
  bool quoted = false;  ///< true for "…", false for <…>
  int line = 0;         ///< counted from 1
};

/// A text file of the project.
struct SourceFile {
  std::string path;  ///< from the repository root, with forward slashes
  std::vector<std::string> lines;
  std::vector<Include> includes;  ///< C++ files only

  bool is_cpp() const;   ///< .cpp or .hpp
  bool is_code() const;  ///< C++, CMake, Python or shell: whatever carries a licence line
  bool in(const std::string& prefix) const { return path.starts_with(prefix); }
};

/// Splits a text into lines and finds its includes.
SourceFile parse(std::string path, const std::string& text);

/// Every text file below the root, sorted by path; leaves out build folders, data and hidden folders other than .ci.
std::vector<SourceFile> read_tree(const std::filesystem::path& root);

}  // namespace msml::repository
