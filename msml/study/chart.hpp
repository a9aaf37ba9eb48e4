// SPDX-License-Identifier: GPL-3.0-or-later
// Charts of a table, drawn by gnuplot from a script that stays beside them.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "msml/study/study.hpp"
#include "msml/study/table.hpp"

namespace msml {

/// What a chart needs to know of its table.
struct ChartStyle {
  std::map<std::string, std::string> labels;  ///< of axes, by column; else the column's name
  bool joined = true;                         ///< points of a curve are joined by lines
};

/// A gnuplot script with its data inside: curves in the colours of Okabe and Ito (2008, jfly.uni-koeln.de/color) with
/// their names at their ends, bars from COLUMN_low to COLUMN_high where there are such columns, slope triangles, and a
/// cross on the lower axis for each run that did not end well. It writes ID.svg, or ID.png with `format='png'`. Throws
/// Error if no row can be drawn.
std::string gnuplot_script(const Table& table, const Chart& chart, const ChartStyle& style);

/// Writes ID.gp and lets gnuplot draw ID.svg and ID.png. What went wrong, or "": without gnuplot the script stays.
std::string draw(const Table& table, const Chart& chart, const ChartStyle& style, const std::filesystem::path& folder);

}  // namespace msml
