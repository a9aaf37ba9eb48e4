// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a map as rectangles of gnuplot.
#include "msml/study/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "msml/core/error.hpp"
#include "msml/study/axes.hpp"

namespace msml {
namespace {

struct Look {
  const char *name, *colour;
};
constexpr std::array<Look, 6> looks{{{"accurate", "#009E73"},
                                     {"accurate, recovered", "#8FD1B5"},
                                     {"inaccurate", "#F0E442"},
                                     {"inaccurate, warned", "#0072B2"},
                                     {"stopped, said so", "#56B4E9"},
                                     {"wrong, unsaid", "#D55E00"}}};
/// Of runs that were not begun, as their reference failed.
constexpr Look unknown{"no reference", "#DDDDDD"};

bool without_reference(const Table& table, std::size_t row) { return table.text(row, "status") == "no reference"; }

/// The distinct values of a column that can be shown, ascending.
std::vector<double> values_of(const Table& table, const std::string& column, bool log) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (const double value = table.number(row, column); std::isfinite(value) && (!log || value > 0))
      values.push_back(value);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.empty()) throw Error(fmt::format("a map needs numbers in {}{}", column, log ? " above 0" : ""));
  return values;
}

/// Words in a column, such as names of laws, become 1, 2, 3, … in the order of their rows. Returns their tics, "" where
/// there are none.
std::string number_words(Table& table, const std::string& column, const char* axis, bool& log) {
  const int place = table.find(column);
  bool found = false;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    found = found || (!table.text(row, column).empty() && !std::isfinite(table.number(row, column)));
  if (place < 0 || !found) return "";
  const std::vector<std::string> words = distinct(table, {column});
  for (auto& row : table.rows) {
    std::string& cell = row[static_cast<std::size_t>(place)];
    cell = std::to_string(std::find(words.begin(), words.end(), cell) - words.begin() + 1);
  }
  log = false;
  std::string tics;
  for (std::size_t i = 0; i < words.size(); ++i)
    tics += fmt::format("{}{} {}", i == 0 ? "" : ", ", quoted(words[i]), i + 1);
  return fmt::format("set {}tics ({}) noenhanced\n", axis, tics);
}

/// Tics at the values of a linear axis, where there are few: what lies between them was not run.
std::string value_tics(const std::vector<double>& values, const char* axis, bool log) {
  if (log || values.size() > 12) return "";
  std::string tics;
  for (const double value : values) tics += fmt::format("{}\"{:g}\" {:g}", tics.empty() ? "" : ", ", value, value);
  return fmt::format("set {}tics ({})\n", axis, tics);
}

/// Borders between neighbouring values, halfway in the scale of the axis, and the outer ones as far out.
std::vector<double> borders(const std::vector<double>& values, bool log) {
  const auto to = [log](double x) { return log ? std::log(x) : x; };
  const auto from = [log](double s) { return log ? std::exp(s) : s; };
  const std::size_t n = values.size();
  const double alone = log ? 0.5 : std::max(0.1 * std::abs(values[0]), 1e-9);
  const double first = n > 1 ? 0.5 * (to(values[1]) - to(values[0])) : alone;
  const double last = n > 1 ? 0.5 * (to(values[n - 1]) - to(values[n - 2])) : alone;
  std::vector<double> found{from(to(values[0]) - first)};
  for (std::size_t i = 1; i < n; ++i) found.push_back(from(0.5 * (to(values[i - 1]) + to(values[i]))));
  found.push_back(from(to(values[n - 1]) + last));
  return found;
}

std::size_t place(const std::vector<double>& values, double value) {
  return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

/// What the colours mean; of `unknown` only where a run has it.
std::string legend(const Table& table) {
  std::vector<Look> shown(looks.begin(), looks.end());
  for (std::size_t row = 0; row < table.rows.size() && shown.size() == looks.size(); ++row)
    if (without_reference(table, row)) shown.push_back(unknown);
  std::string text;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double y = 0.95 - 0.07 * static_cast<double>(i);
    text += fmt::format(
        "set object rectangle from graph 1.03,{:.3f} to graph 1.06,{:.3f} noclip fs solid noborder fc rgb "
        "\"{}\"\nset label \"{}\" at graph 1.075,{:.3f} left\n",
        y - 0.02, y + 0.02, shown[i].colour, shown[i].name, y);
  }
  return text;
}

}  // namespace

Fate fate(const Table& table, std::size_t row, const Chart& chart) {
  if (!table.done(row)) return Fate::said_so;
  const double error = std::abs(table.number(row, chart.color));
  if (error <= chart.accurate) return table.text(row, "recovered").empty() ? Fate::accurate : Fate::recovered;
  if (!table.text(row, "warnings").empty()) return Fate::warned;
  return error <= chart.wrong ? Fate::inaccurate : Fate::wrong;
}

std::string map_script(const Table& all, const Chart& chart, const ChartStyle& style) {
  Table table = filtered(all, chart.only);
  bool log_x = chart.axes.log_x, log_y = chart.axes.log_y;
  const std::string tics = number_words(table, chart.x, "x", log_x) + number_words(table, chart.y, "y", log_y);
  const auto xs = values_of(table, chart.x, log_x), ys = values_of(table, chart.y, log_y);
  const auto x = borders(xs, log_x), y = borders(ys, log_y);
  const Frame frame{{log_x, x.front(), x.back()}, {log_y, y.front(), y.back()}};
  std::string text = chart_head(chart, frame, style, 24) + value_tics(xs, "x", log_x) + value_tics(ys, "y", log_y) +
                     tics + legend(table) + limit_lines(chart, frame.x);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::size_t i = place(xs, table.number(row, chart.x)), k = place(ys, table.number(row, chart.y));
    if (i >= xs.size() || k >= ys.size()) continue;
    const Look& look =
        without_reference(table, row) ? unknown : looks[static_cast<std::size_t>(fate(table, row, chart))];
    text += fmt::format(
        "set object rectangle from first {:.8g},{:.8g} to first {:.8g},{:.8g} behind fs solid border lc "
        "rgb \"#FFFFFF\" fc rgb \"{}\"\n",
        x[i], y[k], x[i + 1], y[k + 1], look.colour);
  }
  text += theory_lines(chart, frame) + "unset grid\nplot " + theory_plots(chart);
  return text + fmt::format("{:.8g} with lines lc rgb \"#FFFFFF\" lw 0 notitle\n", 10 * frame.y.high);
}

}  // namespace msml
