// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of the repository. Each takes the files and returns one sentence per violation, "path:line: what".
#pragma once
#include <set>
#include <string>
#include <vector>

#include "tests/repository/source_tree.hpp"

namespace msml::repository {

using Files = std::vector<SourceFile>;
using Violations = std::vector<std::string>;

/// Own headers are included in quotes, by their path from the repository root, and exist among the files.
Violations includes_from_the_root(const Files& files);

/// msml/core includes nothing of ours but itself, solver and operators add themselves and msml/core, only
/// operators/simulate* adds solver, and the compiler sees nothing of either but the registry (from main.cpp).
Violations layers(const Files& files);

/// No operator includes a header that belongs to another operator of the list. `names` as in operators/CMakeLists.txt.
Violations operators_apart(const Files& files, const std::set<std::string>& names);

/// Each third-party library enters where it may: tinyxml2 and CHOLMOD by one file, CGAL and VTK in operators, VTK in no
/// header, and msml/core uses the standard library, POSIX, Eigen and fmt alone. Tests may include what they like.
Violations third_party_doors(const Files& files);

/// No code file is longer than 400 lines.
Violations short_files(const Files& files);

/// The licence line stands in the first two lines of each code file.
Violations licence_lines(const Files& files);

/// No file names a folder of the machine it was written on.
Violations no_machine_paths(const Files& files);

/// The names in `set(OPERATORS …)` of operators/CMakeLists.txt.
std::set<std::string> listed_operators(const Files& files);

}  // namespace msml::repository
