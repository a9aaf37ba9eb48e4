// SPDX-License-Identifier: GPL-3.0-or-later
// Slopes and crossings of the curves of charts.
#include "msml/study/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/study/fit.hpp"

namespace msml {
namespace {

using Cells = std::vector<std::vector<std::string>>;

constexpr double levels[] = {0.1, 0.05, 0.01, 0.001};

const Measure* measure_of(const Study& study, const std::string& column) {
  for (const Measure& each : study.measures)
    if (each.id == column) return &each;
  return nullptr;
}

bool is_error(const Study& study, const std::string& column) {
  const Measure* found = measure_of(study, column);
  return found && found->against_truth && found->relative;
}

std::string name_of(const Chart& chart, const Curve& curve) {
  std::string name = curve.name;
  for (const auto& [variable, value] : chart.only) name += fmt::format("{}{}", name.empty() ? "" : ", ", value);
  return name;
}

std::string confidence(const Slope& fit) {
  return std::isfinite(fit.half_width) ? fmt::format("± {:.2f}", fit.half_width) : "two runs only";
}

std::vector<std::string> slope_row(const Study& study, const Chart& chart, const Curve& curve) {
  const auto fit = fitted_slope(curve.points);
  if (!fit) return {};
  std::vector<std::string> row{chart.y,
                               chart.x,
                               name_of(chart, curve),
                               fmt::format("{:.2f}", fit->slope),
                               confidence(*fit),
                               std::to_string(fit->count)};
  std::vector<Point> fine = curve.points;
  if (is_error(study, chart.y) && fine.front().y < fine.back().y) std::reverse(fine.begin(), fine.end());
  const std::size_t count = std::max<std::size_t>(3, (fine.size() + 1) / 2);
  fine.erase(fine.begin(), fine.end() - static_cast<std::ptrdiff_t>(std::min(count, fine.size())));
  const auto finer = curve.points.size() > 3 ? fitted_slope(fine) : std::nullopt;
  row.push_back(finer ? fmt::format("{:.2f}", finer->slope) : "");
  row.push_back(finer ? confidence(*finer) : "");
  row.push_back(finer ? std::to_string(finer->count) : "");
  return row;
}

/// Where a curve passes the level, looked for from its accurate end on; or on which side of the level all of it lies.
std::string passing(std::vector<Point> points, double level) {
  const bool rising = points.front().y < points.back().y;
  if (rising) std::reverse(points.begin(), points.end());  // now coarse to fine
  if (points.back().y > level) return "above";
  for (std::size_t i = points.size() - 1; i-- > 0;)
    if (points[i].y > level) return fmt::format("{:.3g}", *reaches({points[i], points[i + 1]}, level));
  return "below";
}

}  // namespace

Page slope_blocks(const Study& study, const Table& table) {
  Cells cells{{"y", "over x", "curve", "slope", "95 % confidence", "runs", "finer half", "95 % confidence", "runs"}};
  for (const Chart& chart : study.charts) {
    if (!chart.axes.log_x || !chart.axes.log_y || !chart.color.empty()) continue;
    if (const Measure* x = measure_of(study, chart.x); x && x->quantity == Quantity::time) continue;
    for (const Curve& curve : curves(filtered(table, chart.only), chart.x, chart.y, chart.group, true))
      if (auto row = slope_row(study, chart, curve); !row.empty()) cells.push_back(std::move(row));
  }
  if (cells.size() == 1) return {};
  return {
      {Block::Kind::heading, "Fitted slopes", {}},
      {Block::Kind::paragraph,
       "Least squares of log y over log x, of all runs and of the finer half. Against unknowns in three dimensions, "
       "order p of the mesh size is a slope of -p/3.",
       {}},
      {Block::Kind::table, "", std::move(cells)}};
}

Page passing_blocks(const Study& study, const Table& table) {
  Cells cells{{"error", "along", "curve", "10 %", "5 %", "1 %", "0.1 %"}};
  const std::vector<std::string> variables = study.variables();
  for (const Chart& chart : study.charts) {
    const bool along_variable = std::find(variables.begin(), variables.end(), chart.x) != variables.end();
    if (!chart.color.empty() || !along_variable || !is_error(study, chart.y)) continue;
    for (const Curve& curve : curves(filtered(table, chart.only), chart.x, chart.y, chart.group, true)) {
      if (curve.points.size() < 2) continue;
      cells.push_back({chart.y, chart.x, name_of(chart, curve)});
      for (const double level : levels) cells.back().push_back(passing(curve.points, level));
    }
  }
  if (cells.size() == 1) return {};
  return {{Block::Kind::heading, "Where the error passes 10 %, 5 %, 1 %, 0.1 %", {}},
          {Block::Kind::paragraph,
           "Between runs by straight lines in the logarithms; \"below\" and \"above\": all runs, or the most accurate "
           "one, lie there.",
           {}},
          {Block::Kind::table, "", std::move(cells)}};
}

}  // namespace msml
