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

/// The last three sizes and values of a curve of three rows at least.
struct Finest {
  std::array<double, 3> sizes{}, values{};
};

Finest finest_of(const Table& table, const Rows& rows, const std::string& variable, const std::string& column) {
  Finest three;
  for (std::size_t i = 0; i < 3; ++i) {
    three.sizes[i] = table.number(rows[rows.size() - 3 + i], variable);
    three.values[i] = table.number(rows[rows.size() - 3 + i], column);
  }
  if (three.sizes[2] > three.sizes[0])
    for (double& size : three.sizes) size = 1 / size;
  return three;
}

/// Fills the errors of a curve; why it stays without, or "".
std::string fill(const Measure& measure, const Rows& rows, const std::string& variable, Table& table) {
  if (rows.size() < 3) return fmt::format("{} of the three runs that a limit needs have a value", rows.size());
  const Finest three = finest_of(table, rows, variable, measure.id + "_value");
  const auto limit = richardson(three.sizes, three.values);
  if (!limit) return why_no_limit(three.sizes, three.values);
  const double scale = measure.relative ? std::abs(limit->value) : 1;
  if (scale == 0) return "the limit is 0, to which no error is relative";
  const auto column = static_cast<std::size_t>(table.find(measure.id));
  for (const std::size_t row : rows)
    table.rows[row][column] =
        fmt::format("{:.10g}", std::abs(table.number(row, measure.id + "_value") - limit->value) / scale);
  return {};
}

/// True if each value of a column goes with one value of the variable only: it is refined along with it.
bool goes_along(const Table& table, const std::string& column, const std::string& variable) {
  const std::vector<std::string> values = distinct(table, {column});
  return values.size() > 1 && distinct(table, {column, variable}).size() == values.size();
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

std::string why_no_limit(const std::array<double, 3>& sizes, const std::array<double, 3>& values) {
  if (richardson(sizes, values)) return {};
  if (!(sizes[0] > sizes[1] && sizes[1] > sizes[2] && sizes[2] > 0))
    return "the variable does not go from coarse to fine in numbers above 0";
  const double first = values[0] - values[1], second = values[1] - values[2];
  const std::string three =
      fmt::format("the last three values {:.6g}, {:.6g}, {:.6g}", values[0], values[1], values[2]);
  if (second == 0) return three + " end with two that are equal";
  if (first / second <= 0) return three + " swing about, instead of approaching a limit from one side";
  return three + (first / second < ratio(sizes, 0.1) ? " do not come closer to each other: no order of 0.1 or more"
                                                     : " come closer faster than any order up to 10");
}

std::vector<NoLimit> extrapolate(const Study& study, Table& table) {
  std::vector<NoLimit> without;
  if (!study.truth || study.truth->extrapolate.empty()) return without;
  const std::string& variable = study.truth->extrapolate;
  std::vector<std::string> others = study.variables();
  std::erase_if(others, [&](const std::string& each) { return each == variable || goes_along(table, each, variable); });
  for (const std::string& group : distinct(table, others))
    for (const Measure& measure : study.measures) {
      if (!measure.extrapolated) continue;
      Rows rows;
      for (std::size_t row = 0; row < table.rows.size(); ++row)
        if (table.words(row, others) == group && std::isfinite(table.number(row, measure.id + "_value")))
          rows.push_back(row);
      if (const std::string why = fill(measure, rows, variable, table); !why.empty())
        without.push_back({measure.id, group, why});
    }
  return without;
}

}  // namespace msml
