// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares, fronts and crossings.
#include "msml/study/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace msml {
namespace {

/// The 97.5 % point of Student's t distribution.
double student(std::size_t freedom) {
  constexpr std::array<double, 11> table{0, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  if (freedom == 0) return std::numeric_limits<double>::infinity();
  if (freedom < table.size()) return table[freedom];
  // Cornish and Fisher's expansion in 1/freedom, within 0.1 % from 10 on.
  const double z = 1.959964, n = static_cast<double>(freedom);
  return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

bool by_x(const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

}  // namespace

std::vector<Curve> curves(const Table& table, const std::string& x, const std::string& y,
                          const std::vector<std::string>& group, bool log) {
  std::vector<Curve> found;
  for (const std::string& name : distinct(table, group)) {
    Curve curve{name, {}};
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      if (!table.done(row) || table.words(row, group) != name) continue;
      const Point point{table.number(row, x), table.number(row, y), row};
      const bool there = std::isfinite(point.x) && std::isfinite(point.y);
      if (there && (!log || (point.x > 0 && point.y > 0))) curve.points.push_back(point);
    }
    std::stable_sort(curve.points.begin(), curve.points.end(), by_x);
    if (!curve.points.empty()) found.push_back(std::move(curve));
  }
  return found;
}

std::optional<Slope> fitted_slope(const std::vector<Point>& points) {
  const double n = static_cast<double>(points.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (const Point& p : points) mean_x += std::log(p.x) / n, mean_y += std::log(p.y) / n;
  for (const Point& p : points) {
    const double dx = std::log(p.x) - mean_x;
    xx += dx * dx;
    xy += dx * (std::log(p.y) - mean_y);
  }
  if (points.size() < 2 || !(xx > 0)) return std::nullopt;
  const double slope = xy / xx;
  for (const Point& p : points) {
    const double r = std::log(p.y) - mean_y - slope * (std::log(p.x) - mean_x);
    rest += r * r;
  }
  const std::size_t freedom = points.size() - 2;
  const double width = freedom == 0 ? std::numeric_limits<double>::infinity()
                                    : student(freedom) * std::sqrt(rest / static_cast<double>(freedom) / xx);
  return Slope{slope, width, points.size()};
}

std::vector<Point> pareto_front(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), by_x);
  std::vector<Point> front;
  for (const Point& point : points)
    if (front.empty() || point.y < front.back().y) front.push_back(point);
  return front;
}

std::optional<double> reaches(const std::vector<Point>& points, double level) {
  std::optional<double> least;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point &a = points[i - 1], &b = points[i];
    if (a.y <= level || b.y > level) continue;
    const double s = (std::log(level) - std::log(a.y)) / (std::log(b.y) - std::log(a.y));
    const double x = std::exp(std::log(a.x) + s * (std::log(b.x) - std::log(a.x)));
    least = std::min(x, least.value_or(x));
  }
  return least;
}

}  // namespace msml
