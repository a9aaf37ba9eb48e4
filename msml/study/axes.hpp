// SPDX-License-Identifier: GPL-3.0-or-later
// What all charts have in common: axes, heads of scripts, and the lines of theory. Internal to msml/study.
#pragma once
#include <string>
#include <vector>

#include "msml/study/chart.hpp"

namespace msml {

/// One axis: where its values lie, and how they map to 0 … 1.
struct Axis {
  bool log = false;
  double low = 0, high = 1;
  double share(double value) const {
    return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
};

/// Both axes of a chart.
struct Frame {
  Axis x, y;
};

/// The axis that shows all values with a margin, a share of what they span.
Axis axis_over(const std::vector<double>& values, bool log, double margin);

/// A text inside double quotes of gnuplot, without markup.
std::string quoted(const std::string& text);

/// Terminal, output, title, labels, ranges and tics; `right` characters of space stay free on the right.
std::string chart_head(const Chart& chart, const Frame& frame, const ChartStyle& style, std::size_t right);

/// Dashed lines across at the values of x that theory names.
std::string limit_lines(const Chart& chart, const Axis& x);
/// Samples of the lines that theory gives, where they lie inside the chart, as data blocks $theory0, …
std::string theory_lines(const Chart& chart, const Frame& frame);
/// What `plot` says of these blocks.
std::string theory_plots(const Chart& chart);

}  // namespace msml
