// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of the repository, each a function from files to violations.
#include "tests/repository/rules.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>

namespace msml::repository {
namespace {

std::string at(const SourceFile& file, int line, const std::string& what) {
  return file.path + ":" + std::to_string(line) + ": " + what;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) { return text.starts_with(prefix); });
}

const std::vector<std::string> our_folders = {"msml/", "solver/", "operators/", "tests/"};

/// What a file may include of ours.
std::vector<std::string> allowed_layers(const SourceFile& file) {
  if (file.in("msml/core/")) return {"msml/core/"};
  if (file.path == "msml/main.cpp") return {"msml/", "operators/registry.hpp"};
  // The program's own command, outside the compiler's library: it measures with the helper that ComputeMeanError uses.
  if (file.path == "msml/commands/compare.cpp") return {"msml/", "operators/compare_meshes.hpp"};
  if (file.in("msml/")) return {"msml/"};
  if (file.in("solver/")) return {"solver/", "msml/core/"};
  if (file.in("operators/simulate")) return {"operators/", "msml/core/", "solver/"};
  if (file.in("operators/")) return {"operators/", "msml/core/"};
  return our_folders;
}

struct Door {
  std::string library;
  std::regex header;
  std::vector<std::string> folders;  ///< where it may enter
  bool in_headers;                   ///< whether a .hpp may include it
  std::size_t files;                 ///< in how many files at most; 0 = any number
};

std::vector<Door> doors() {
  return {{"tinyxml2", std::regex("^tinyxml2\\.h$"), {"msml/document/"}, false, 1},
          {"SuiteSparse", std::regex("^(suitesparse/)?(cholmod|umfpack|klu|SuiteSparse).*"), {"solver/"}, false, 1},
          {"muParser", std::regex("^muParser.*"), {"msml/core/formula.cpp"}, false, 1},
          {"CGAL", std::regex("^CGAL/.*"), {"operators/"}, true, 0},
          {"VTK", std::regex("^vtk[A-Za-z0-9_]*\\.h$"), {"operators/"}, false, 0},
          {"CLI11", std::regex("^CLI/.*"), {"msml/main.cpp", "msml/cli"}, false, 1}};
}

Violations through(const Door& door, const Files& files) {
  Violations found;
  std::set<std::string> users;
  for (const auto& file : files)
    for (const auto& include : file.includes) {
      if (file.in("tests/") || !std::regex_match(include.name, door.header)) continue;
      users.insert(file.path);
      if (!starts_with_any(file.path, door.folders)) found.push_back(at(file, include.line, door.library + " here"));
      if (!door.in_headers && file.path.ends_with(".hpp"))
        found.push_back(at(file, include.line, door.library + " in a header"));
    }
  if (door.files > 0 && users.size() > door.files)
    for (const auto& user : users)
      found.push_back(user + ": one of " + std::to_string(users.size()) + " doors of " + door.library);
  return found;
}

Violations core_is_plain(const Files& files) {
  static const std::regex plain("^([a-z_]+|(fcntl|unistd|sys/[a-z]+)\\.h|(unsupported/)?Eigen/.*|fmt/.*)$");
  Violations found;
  for (const auto& file : files)
    for (const auto& include : file.includes)
      if (file.in("msml/core/") && !include.quoted && !std::regex_match(include.name, plain) &&
          !(file.path == "msml/core/formula.cpp" && include.name == "muParser.h"))
        found.push_back(at(file, include.line, "msml/core does not use <" + include.name + ">"));
  return found;
}

}  // namespace

Violations includes_from_the_root(const Files& files) {
  std::set<std::string> paths;
  for (const auto& file : files) paths.insert(file.path);
  Violations found;
  for (const auto& file : files)
    for (const auto& include : file.includes) {
      if (include.quoted && !paths.contains(include.name))
        found.push_back(at(file, include.line, "no file \"" + include.name + "\" below the root"));
      if (!include.quoted && starts_with_any(include.name, our_folders))
        found.push_back(at(file, include.line, "own header in angle brackets: " + include.name));
    }
  return found;
}

Violations layers(const Files& files) {
  Violations found;
  for (const auto& file : files)
    for (const auto& include : file.includes)
      if (starts_with_any(include.name, our_folders) && !starts_with_any(include.name, allowed_layers(file)))
        found.push_back(at(file, include.line, "must not include " + include.name));
  return found;
}

Violations operators_apart(const Files& files, const std::set<std::string>& names) {
  Violations found;
  for (const auto& file : files)
    for (const auto& include : file.includes) {
      const auto name = std::filesystem::path(include.name).stem().string();
      const bool of_an_operator = include.name.starts_with("operators/") && names.contains(name);
      if (of_an_operator && !file.in("operators/" + name + ".") && !file.in("tests/"))
        found.push_back(at(file, include.line, "includes the operator " + name));
    }
  return found;
}

Violations third_party_doors(const Files& files) {
  Violations found = core_is_plain(files);
  for (const auto& door : doors()) {
    const auto more = through(door, files);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

Violations short_files(const Files& files) {
  Violations found;
  for (const auto& file : files)
    if (file.is_code() && file.lines.size() > 400)
      found.push_back(file.path + ": " + std::to_string(file.lines.size()) + " lines");
  return found;
}

Violations licence_lines(const Files& files) {
  const std::string wanted = "SPDX-License-Identifier: GPL-3.0-or-later";
  Violations found;
  for (const auto& file : files) {
    const auto end = file.lines.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, file.lines.size()));
    const auto has = [&](const std::string& line) { return line.find(wanted) != std::string::npos; };
    if (file.is_code() && std::none_of(file.lines.begin(), end, has)) found.push_back(file.path + ": no licence line");
  }
  return found;
}

Violations no_machine_paths(const Files& files) {
  // Written apart so that this file does not name them itself.
  static const std::regex machine(
      "/"
      "work/|/"
      "tmp/|/"
      "root/|/"
      "home/[a-z]");
  Violations found;
  for (const auto& file : files)
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      if (std::regex_search(file.lines[i], machine))
        found.push_back(at(file, static_cast<int>(i) + 1, "names a folder of one machine"));
  return found;
}

std::set<std::string> listed_operators(const Files& files) {
  std::set<std::string> names;
  for (const auto& file : files) {
    if (file.path != "operators/CMakeLists.txt") continue;
    bool inside = false;
    for (const auto& line : file.lines) {
      std::istringstream words(line.substr(0, line.find('#')));
      for (std::string word; words >> word;) {
        if (word == ")" || (inside && word.ends_with(")"))) inside = false;
        if (inside) names.insert(word);
        if (word.starts_with("set(OPERATORS")) inside = true;
      }
    }
  }
  return names;
}

}  // namespace msml::repository
