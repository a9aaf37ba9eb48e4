// SPDX-License-Identifier: GPL-3.0-or-later
// The list of verification cases: what is run, what is measured, what it must come to.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace msml::verification {

/// Where a number is read after a run: a JSON pointer into the report of the node `node` (such as "/check/volumeChange"
/// or "/values/error"), or columns of a table that the run wrote.
struct Measure {
  std::string node, pointer;  ///< of the report
  std::string file;           ///< or of a table
  std::string column;         ///< sums as "elastic+kinetic-external_work"; "reaction_z*": all that start so
  /// What is made of the column: last, largest (absolute), spread (largest less smallest, over the largest absolute),
  /// slope (of the last two rows over time), period (mean time between rises through zero), or at (value where `where`
  /// passes `place`, by a parabola between rows; where_file: in another table with the same rows).
  std::string reduce = "last", where, where_file;
  double place = 0;
};

/// One way to compute a case: variables to set and tags to exchange in the scene. Where `vary` names a variable, the
/// method is run for each of its values, coarse to fine, and must converge, where `order` is given with that. A method
/// that lacks one of its `files`, as those outside the sources may be, is left out.
struct Method {
  std::string name;
  std::map<std::string, std::string> set, replace;
  std::map<std::string, std::string> files;  ///< variables that name a file: of the results, or beside the scenes
  std::string vary;
  std::vector<std::map<std::string, std::string>> values;  ///< of `vary`, and of what goes with it
  std::optional<double> expect;  ///< number that the measure must come to; absent: the measure is an error, to be zero
  std::optional<double> order;   ///< of convergence in 1/value, within 0.15, in the last pair
  std::string more;              ///< why a higher order is no fault; empty: it is one
  bool self = false;             ///< the error of a run is its difference from the one before; the first has none
  double limit = 0;              ///< of the last run's error: relative to `expect` where that is not zero
  double above = 0;              ///< the error must be at least this: where theory says that a method fails
  int exit_code = 0;             ///< what the program must end with
  int iterations = 0;            ///< of Newton's method over the whole run, at most; 0: as many as it takes
  Measure measure;
  std::string says;  ///< words that its messages or its report must hold
};

/// A problem with its reference.
struct Case {
  std::string name, scene, source;
  bool smoke = false;
  std::vector<Method> methods;
};

/// Throws std::runtime_error on a file that cannot be read or a key that is not known.
std::vector<Case> read_cases(const std::filesystem::path& file);

}  // namespace msml::verification
