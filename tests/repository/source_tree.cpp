// SPDX-License-Identifier: GPL-3.0-or-later
// The project's own text files, read once so that rules about them can be tested.
#include "tests/repository/source_tree.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <sstream>
#include <string_view>

namespace msml::repository {
namespace fs = std::filesystem;
namespace {

bool ends_in(std::string_view path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return path.ends_with(ending); });
}

bool is_shell(std::string_view path) { return path == "dev" || path == ".ci/run" || ends_in(path, {".sh", "/run"}); }

bool is_text(std::string_view path) {
  return is_shell(path) || ends_in(path, {".cpp", ".hpp", ".in", ".cmake", ".txt", ".py", ".xml", ".md", ".dot",
                                          ".gitignore", ".clang-tidy"});
}

bool skip_folder(const std::string& name) {
  return name.starts_with("build") || name == "data" || (name.starts_with(".") && name != ".ci");
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

bool SourceFile::is_cpp() const { return ends_in(path, {".cpp", ".hpp"}); }

bool SourceFile::is_code() const {
  return is_cpp() || is_shell(path) || ends_in(path, {"CMakeLists.txt", ".cmake", ".py", ".cpp.in", ".hpp.in"});
}

SourceFile parse(std::string path, const std::string& text) {
  static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  SourceFile file{.path = std::move(path), .lines = {}, .includes = {}};
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    file.lines.push_back(line);
    std::smatch match;
    if (file.is_cpp() && std::regex_search(line, match, include))
      file.includes.push_back({match[2], match[1] == "\"", static_cast<int>(file.lines.size())});
  }
  return file;
}

std::vector<SourceFile> read_tree(const fs::path& root) {
  std::vector<SourceFile> files;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && skip_folder(entry->path().filename().string())) entry.disable_recursion_pending();
    if (!entry->is_regular_file()) continue;
    const std::string path = fs::relative(entry->path(), root).generic_string();
    if (is_text(path)) files.push_back(parse(path, read_text(entry->path())));
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

}  // namespace msml::repository
