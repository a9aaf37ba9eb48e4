// SPDX-License-Identifier: GPL-3.0-or-later
// What the columns of a study's table mean: units, and words for the axes of charts.
#pragma once
#include <map>
#include <string>

#include "msml/compile/compile.hpp"
#include "msml/study/table.hpp"

namespace msml {

/// The unit of every column of the table, in the labels of the scene: "s", "bytes", "1", "length" or "mm"; "text" where
/// a column holds words; "" for a variable that fills no attribute with a unit.
std::map<std::string, std::string> column_units(const Study& study, const Table& table, const Compilation& scene);

/// What stands at the axes of charts: "relative RMS error of displacement [1]", "time of one step [s]", "E [stress]".
std::map<std::string, std::string> column_labels(const Study& study, const Table& table, const Compilation& scene);

}  // namespace msml
