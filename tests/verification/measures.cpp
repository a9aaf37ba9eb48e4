// SPDX-License-Identifier: GPL-3.0-or-later
// Columns and what is made of them.
#include "tests/verification/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace msml::verification {
namespace {

using Column = std::vector<double>;

/// A file of numbers with a line of names.
struct Table {
  std::vector<std::string> names;
  std::vector<Column> columns;
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
  return found;
}

/// Adds `sign` times the columns called `name`, or all that start with it where it ends in a star.
void add(const Table& table, const std::string& name, double sign, Column& sum) {
  const bool all = !name.empty() && name.back() == '*';
  const std::string start = all ? name.substr(0, name.size() - 1) : name;
  bool found = false;
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    if (all ? !table.names[c].starts_with(start) : table.names[c] != name) continue;
    found = true;
    for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += sign * table.columns[c][r];
  }
  if (!found) throw std::runtime_error("the table has no column " + name);
}

Column column_of(const Table& table, const std::string& terms) {
  Column sum(table.columns.front().size(), 0.0);
  double sign = 1;
  std::size_t at = 0;
  while (at < terms.size()) {
    const std::size_t end = std::min(terms.find_first_of("+-", at), terms.size());
    add(table, terms.substr(at, end - at), sign, sum);
    if (end < terms.size()) sign = terms[end] == '-' ? -1 : 1;
    at = end + 1;
  }
  return sum;
}

double largest(const Column& values) {
  double found = 0;
  for (const double value : values) found = std::max(found, std::abs(value));
  return found;
}

double spread(const Column& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return (*high - *low) / largest(values);
}

double slope(const Column& values, const Column& time) {
  const std::size_t n = values.size();
  if (n < 2) throw std::runtime_error("a slope takes two rows");
  return (values[n - 1] - values[n - 2]) / (time[n - 1] - time[n - 2]);
}

/// Mean time between the first and the last rise through zero.
double period(const Column& values, const Column& time) {
  Column rises;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i - 1] < 0 && values[i] >= 0)
      rises.push_back(time[i - 1] + (time[i] - time[i - 1]) * values[i - 1] / (values[i - 1] - values[i]));
  if (rises.size() < 2) throw std::runtime_error("a period takes two rises through zero");
  return (rises.back() - rises.front()) / static_cast<double>(rises.size() - 1);
}

/// Value of the parabola through the three rows around the first passage.
double value_at(const Column& values, const Column& where, double place) {
  std::size_t i = 1;
  while (i < values.size() && ((where[i - 1] - place) * (where[i] - place) > 0 || where[i] == where[i - 1])) ++i;
  if (i >= values.size()) throw std::runtime_error(fmt::format("the table does not reach {:g}", place));
  const std::size_t first = i + 1 < values.size() ? i - 1 : i - std::min<std::size_t>(i, 2);
  const std::size_t count = std::min<std::size_t>(3, values.size() - first);
  double sum = 0;
  for (std::size_t k = first; k < first + count; ++k) {
    double weight = 1;
    for (std::size_t m = first; m < first + count; ++m)
      if (m != k) weight *= (place - where[m]) / (where[k] - where[m]);
    sum += weight * values[k];
  }
  return sum;
}

/// Throws std::runtime_error on a file that cannot be read or has no row.
Table read_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw std::runtime_error("cannot read " + file.filename().string());
  Table table{cells(line), {}};
  table.columns.resize(table.names.size());
  while (std::getline(stream, line)) {
    const std::vector<std::string> row = cells(line);
    if (row.size() != table.names.size()) continue;
    for (std::size_t c = 0; c < row.size(); ++c) table.columns[c].push_back(std::stod(row[c]));
  }
  if (table.columns.front().empty()) throw std::runtime_error(file.filename().string() + " has no row");
  return table;
}

}  // namespace

double measured(const Measure& measure, const std::filesystem::path& folder) {
  const Table table = read_table(folder / measure.file);
  const Column values = column_of(table, measure.column);
  if (measure.reduce == "last") return values.back();
  if (measure.reduce == "largest") return largest(values);
  if (measure.reduce == "spread") return spread(values);
  if (measure.reduce == "slope") return slope(values, table.columns.front());
  if (measure.reduce == "period") return period(values, table.columns.front());
  if (measure.reduce == "at") {
    const Table other = measure.where_file.empty() ? table : read_table(folder / measure.where_file);
    return value_at(values, column_of(other, measure.where), measure.place);
  }
  throw std::runtime_error("reduce = '" + measure.reduce + "' is not known");
}

}  // namespace msml::verification
