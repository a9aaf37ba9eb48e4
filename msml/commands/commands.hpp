// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of the program. Each returns the exit code and prints its own messages.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "msml/compile/compile.hpp"
#include "msml/core/registry.hpp"
#include "msml/run/terminal.hpp"

namespace msml {

/// What stands on the command line of exec, check and show.
struct SceneArguments {
  std::string scene;
  std::string output_folder = ".";
  std::vector<std::string> set;        ///< "name=value"
  std::vector<std::string> requested;  ///< ids
  std::string log_json;
  int jobs = 0, threads = 0;  ///< 0: as many as there are processors
  bool dry_run = false, verbose = false, quiet = false, strict = false;
};

/// Runs a scene. 0 done, 2 bad input, 3 not converged or out of memory, 4 internal.
int exec_command(const Registry& registry, const SceneArguments& arguments);
/// Compiles a scene, and each setting of its studies, and says what it found. 0 or 2.
int check_command(const Registry& registry, const SceneArguments& arguments);
/// Prints the graph as DOT, or writes it as FILE.dot or FILE.svg.
int show_command(const Registry& registry, const SceneArguments& arguments, const std::string& file);

/// What stands on the command line of compare.
struct CompareArguments {
  std::string a, b;
  double tolerance = 0;  ///< largest allowed maximum difference, relative to the largest value of B
  bool has_tolerance = false;
  std::vector<std::string> fields;  ///< only these; empty: all that both have
};
/// Differences of the fields of two files. 0 within tolerance (or none given), 1 above.
int compare_command(const Registry& registry, const CompareArguments& arguments);

/// Prints faults, warnings and (when verbose) notes of a compilation to stderr; true if there are no faults.
bool print_messages(const Compilation& compilation, Verbosity verbosity);

/// Splits "name=value" settings. Throws Error for one without '='.
std::map<std::string, std::string> settings(const std::vector<std::string>& set);

}  // namespace msml
