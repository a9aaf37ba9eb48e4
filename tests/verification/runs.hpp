// SPDX-License-Identifier: GPL-3.0-or-later
// Runs scenes of the verification and reads what came out.
#pragma once
#include "tests/verification/cases.hpp"

namespace msml::verification {

/// The program under test and its folders.
struct Program {
  std::filesystem::path msml, scenes, results;
};

/// One line of the table.
struct Row {
  std::string name, method, source;
  long unknowns = 0;
  std::optional<double> value, expect, error, order;
  double limit = 0, above = 0, seconds = 0;
  std::optional<double> order_asked;
  std::string more;  ///< why a higher order is no fault
  bool pass = false;
  std::string remark;  ///< why it failed, or what was asked for beside the limit
};

/// A run that was made.
struct Run {
  std::filesystem::path folder;
  int exit_code = 0;
};

/// Runs by scene and variables: rows that read other numbers of the same run share it.
using Runs = std::map<std::string, Run>;

/// All runs of a method, coarse to fine. A run that cannot be read is a failed row with a remark. The limit and the
/// order are asked of the last.
std::vector<Row> run_method(const Program& program, const Case& each, const Method& method, Runs& runs);

}  // namespace msml::verification
