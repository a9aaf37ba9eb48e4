// SPDX-License-Identifier: GPL-3.0-or-later
// What a table of errors and times says: orders of convergence, the Pareto front, what an accuracy costs.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "msml/study/table.hpp"

namespace msml {

/// A point of a curve, with the row of the table it comes from.
struct Point {
  double x = 0, y = 0;
  std::size_t row = 0;
};

/// The points with both numbers, x ascending. `log`: only positive ones. Rows that are not done are left out.
struct Curve {
  std::string name;
  std::vector<Point> points;
};
std::vector<Curve> curves(const Table& table, const std::string& x, const std::string& y,
                          const std::vector<std::string>& group, bool log);

/// Slope of log y over log x by least squares; `half_width` is half of its 95 % confidence interval by Student's t
/// (infinite for two points).
struct Slope {
  double slope = 0, half_width = 0;
  std::size_t count = 0;
};
/// Nothing for fewer than two points or equal x.
std::optional<Slope> fitted_slope(const std::vector<Point>& points);

/// The points that no other beats in both x and y, x ascending.
std::vector<Point> pareto_front(std::vector<Point> points);

/// The smallest x at which a curve, followed from coarse to fine, comes down to y <= `level`, between its points by a
/// straight line in the logarithms; nothing if it never does, or is below from its first point on (then nothing is
/// known of cheaper settings).
std::optional<double> reaches(const std::vector<Point>& points, double level);

}  // namespace msml
