// SPDX-License-Identifier: GPL-3.0-or-later
// Maps: two variables, and what became of each pair of their values.
#pragma once
#include "msml/study/chart.hpp"

namespace msml {

/// What became of a run, in the order of the legend.
enum class Fate : std::uint8_t { accurate, recovered, inaccurate, warned, said_so, wrong };

/// Accurate or inaccurate by the error and the chart's bound, the latter with or without a warning, the former as it
/// went or after the program had made something good on the way (column `recovered`); a run that stopped
/// with a reason said so; one that ends well and without a warning, with an error above the chart's `wrong` or with
/// none, does not.
Fate fate(const Table& table, std::size_t row, const Chart& chart);

/// A gnuplot script: a cell for each run, coloured by its fate, with the lines of theory over them. Words on an axis
/// stand side by side. Throws Error if x or y hold nothing.
std::string map_script(const Table& table, const Chart& chart, const ChartStyle& style);

}  // namespace msml
