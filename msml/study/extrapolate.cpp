// SPDX-License-Identifier: GPL-3.0-or-later
// Richardson's limit of three values, and the errors against it.
#include "msml/study/extrapolate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace msml {
namespace {

/// What (f1 - f2) / (f2 - f3) is for an order; it rises with the order.
double ratio(const std::array<double, 3>& h, double order) {
  return (std::pow(h[0], order) - std::pow(h[1], order)) / (std::pow(h[1], order) - std::pow(h[2], order));
}

/// Rows of one curve, in the order of the table.
using Rows = std::vector<std::size_t>;

std::optional<Limit> limit_of(const Table& table, const Rows& rows, const std::string& variable,
                              const std::string& column) {
  if (rows.size() < 3) return std::nullopt;
  std::array<double, 3> sizes{}, values{};
  for (std::size_t i = 0; i < 3; ++i) {
    sizes[i] = table.number(rows[rows.size() - 3 + i], variable);
    values[i] = table.number(rows[rows.size() - 3 + i], column);
  }
  if (sizes[2] > sizes[0])
    for (double& size : sizes) size = 1 / size;
  return richardson(sizes, values);
}

void fill(const Measure& measure, const Rows& rows, const std::string& variable, Table& table) {
  const auto limit = limit_of(table, rows, variable, measure.id + "_value");
  if (!limit) return;
  const auto column = static_cast<std::size_t>(table.find(measure.id));
  for (const std::size_t row : rows) {
    const double error = std::abs(table.number(row, measure.id + "_value") - limit->value);
    const double scale = measure.relative ? std::abs(limit->value) : 1;
    if (scale > 0) table.rows[row][column] = fmt::format("{:.10g}", error / scale);
  }
}

}  // namespace

std::optional<Limit> richardson(const std::array<double, 3>& sizes, const std::array<double, 3>& values) {
  const bool ordered = sizes[0] > sizes[1] && sizes[1] > sizes[2] && sizes[2] > 0;
  const double first = values[0] - values[1], second = values[1] - values[2];
  double low = 0.1, high = 10;
  if (!ordered || second == 0 || !(ratio(sizes, low) <= first / second && first / second <= ratio(sizes, high)))
    return std::nullopt;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio(sizes, middle) < first / second ? low : high) = middle;
  }
  const double fine = std::pow(sizes[2], low), coarse = std::pow(sizes[1], low);
  return Limit{values[2] - second * fine / (coarse - fine), low};
}

void extrapolate(const Study& study, Table& table) {
  if (!study.truth || study.truth->extrapolate.empty()) return;
  std::vector<std::string> others = study.variables();
  std::erase(others, study.truth->extrapolate);
  for (const std::string& group : distinct(table, others))
    for (const Measure& measure : study.measures) {
      if (!measure.extrapolated) continue;
      Rows rows;
      for (std::size_t row = 0; row < table.rows.size(); ++row)
        if (table.words(row, others) == group && std::isfinite(table.number(row, measure.id + "_value")))
          rows.push_back(row);
      fill(measure, rows, study.truth->extrapolate, table);
    }
}

}  // namespace msml
