// SPDX-License-Identifier: GPL-3.0-or-later
// Table -> gnuplot script -> SVG and PNG.
#include "msml/study/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "msml/core/atomic_file.hpp"
#include "msml/core/error.hpp"
#include "msml/run/program.hpp"
#include "msml/study/axes.hpp"
#include "msml/study/fit.hpp"
#include "msml/study/map.hpp"

namespace msml {
namespace {

constexpr std::array<const char*, 8> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#000000", "#8C8C00"};
constexpr std::array<int, 8> marks{7, 5, 9, 11, 13, 6, 4, 8};

class Drawing {
 public:
  Drawing(const Table& table, const Chart& chart, const ChartStyle& style)
      : names_(distinct(table, chart.group)), table_(filtered(table, chart.only)), chart_(chart), style_(style) {
    name_positions();
    if (chart_.y == share_column) add_shares();
    const bool log = chart_.axes.log_x || chart_.axes.log_y;
    curves_ = curves(table_, chart.x, chart.y, chart.group, log);
    if (!chart_.axes.log_x || !chart_.axes.log_y) keep_fitting();
    if (has_bars(chart.x)) sort_by_row();
    std::vector<double> xs, ys;
    for (const Curve& curve : curves_)
      for (const Point& point : curve.points) {
        xs.push_back(point.x), ys.push_back(point.y);
        if (chart_.y == share_column) continue;
        for (const char* end : {"_low", "_high"}) {
          add(xs, point.row, chart.x + end, chart_.axes.log_x);
          add(ys, point.row, chart.y + end, chart_.axes.log_y);
        }
      }
    if (xs.empty())
      throw Error(fmt::format("chart '{}': no run has both {} and {} as numbers{}", chart.id, chart.x, chart.y,
                              log ? " > 0" : ""));
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (!table_.done(row)) add(xs, row, chart.x, chart_.axes.log_x);
    x_ = axis_over(xs, chart_.axes.log_x, 0.06);
    y_ = axis_over(ys, chart_.axes.log_y, 0.08);
  }

  std::string script() {
    std::string text = chart_head(chart_, {x_, y_}, style_, name_width());
    if (!words_.empty()) text += word_tics();
    for (std::size_t i = 0; i < curves_.size(); ++i) text += data(i);
    const std::string failures = failed();
    text += labels() + triangles() + limit_lines(chart_, x_) + theory_lines(chart_, {x_, y_}) + failures + "plot ";
    text += theory_plots(chart_);
    for (std::size_t i = 0; i < curves_.size(); ++i) text += (i == 0 ? "" : ", \\\n     ") + plot(i);
    return text +
           (failures.find("$failed") == std::string::npos
                ? ""
                : ", \\\n     $failed with points pt 2 ps 1.4 lw 2 lc rgb \"#B00000\" notitle") +
           "\n";
  }

 private:
  /// Words on the x axis, such as names of elements, stand at 1, 2, 3, …
  void name_positions() {
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (!table_.text(row, chart_.x).empty() && !std::isfinite(table_.number(row, chart_.x)))
        words_ = distinct(table_, {chart_.x});
    const int column = table_.find(chart_.x);
    for (auto& row : table_.rows)
      for (std::size_t i = 0; i < words_.size(); ++i)
        if (row[static_cast<std::size_t>(column)] == words_[i]) {
          row[static_cast<std::size_t>(column)] = std::to_string(i + 1);
          break;
        }
    if (!words_.empty()) chart_.axes.log_x = false;
  }

  /// The column of the empirical distribution of x.
  void add_shares() {
    std::vector<double> all;
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (table_.done(row)) add(all, row, chart_.x, false);
    std::sort(all.begin(), all.end());
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const double x = table_.number(row, chart_.x);
      const auto rank = std::upper_bound(all.begin(), all.end(), x) - all.begin();
      table_.rows[row].push_back(
          std::isfinite(x) ? fmt::format("{:.6g}", static_cast<double>(rank) / static_cast<double>(all.size())) : "");
    }
    table_.columns.emplace_back(share_column);
  }

  std::string word_tics() const {
    std::string tics;
    for (std::size_t i = 0; i < words_.size(); ++i)
      tics += fmt::format("{}{} {}", i == 0 ? "" : ", ", quoted(words_[i]), i + 1);
    return "set xtics (" + tics + ") noenhanced\n";
  }

  /// curves() keeps positive numbers only where any axis is logarithmic: here only those that their own axis can show.
  void keep_fitting() {
    curves_ = curves(table_, chart_.x, chart_.y, chart_.group, false);
    for (Curve& curve : curves_)
      std::erase_if(curve.points, [&](const Point& point) {
        return (chart_.axes.log_x && point.x <= 0) || (chart_.axes.log_y && point.y <= 0);
      });
    std::erase_if(curves_, [](const Curve& curve) { return curve.points.empty(); });
  }

  /// Along a measured time the points follow each other as in the table: from coarse to fine, not by noise.
  void sort_by_row() {
    for (Curve& curve : curves_)
      std::sort(curve.points.begin(), curve.points.end(), [](const Point& a, const Point& b) { return a.row < b.row; });
  }

  void add(std::vector<double>& values, std::size_t row, const std::string& column, bool log) const {
    const double value = table_.number(row, column);
    if (std::isfinite(value) && (!log || value > 0)) values.push_back(value);
  }

  std::size_t name_width() const {
    std::size_t width = 2;
    if (curves_.size() > 1)
      for (const Curve& curve : curves_) width = std::max(width, curve.name.size() + 3);
    return std::min<std::size_t>(width * 9 / 10, 32);  // letters are narrower than gnuplot takes them to be
  }

  /// Of a distribution the spread is the message, not that of each time.
  bool has_bars(const std::string& column) const {
    return chart_.y != share_column && table_.find(column + "_low") >= 0;
  }

  std::string data(std::size_t i) const {
    std::string text = fmt::format("$curve{} << EOD\n", i);
    for (const Point& point : curves_[i].points) {
      const auto end = [&](const std::string& column, double fallback) {
        const double value = table_.number(point.row, column);
        return std::isfinite(value) ? value : fallback;
      };
      text += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g}\n", point.x, point.y,
                          end(chart_.x + "_low", point.x), end(chart_.x + "_high", point.x),
                          end(chart_.y + "_low", point.y), end(chart_.y + "_high", point.y));
    }
    return text + "EOD\n";
  }

  /// Bars first, so that the marks lie on them.
  std::string plot(std::size_t i) const {
    const bool joined = style_.joined && curves_[i].points.size() > 1;
    std::string text;
    for (const auto& [column, bars] :
         {std::pair{chart_.x, "1:2:3:4 with xerrorbars"}, std::pair{chart_.y, "1:2:5:6 with yerrorbars"}})
      if (has_bars(column))
        text += fmt::format("$curve{} using {} lw 1.5 pt 0 lc rgb \"{}\" notitle, \\\n     ", i, bars, colour(i));
    return text + fmt::format("$curve{} using 1:2 with {} lw 2 dt {} pt {} ps 1.1 lc rgb \"{}\" notitle", i,
                              joined ? "linespoints" : "points", look(i) / colours.size() + 1,
                              marks[look(i) % marks.size()], colour(i));
  }

  /// Names on the right, moved apart where they would overlap, with a thin line to a curve that ends inside.
  std::string labels() const {
    if (curves_.size() < 2) return {};
    constexpr double apart = 0.045;
    std::vector<std::pair<double, std::size_t>> places;
    for (std::size_t i = 0; i < curves_.size(); ++i) places.emplace_back(y_.share(curves_[i].points.back().y), i);
    std::sort(places.begin(), places.end());
    for (std::size_t k = 1; k < places.size(); ++k)
      places[k].first = std::max(places[k].first, places[k - 1].first + apart);
    if (const double over = places.back().first - 0.98; over > 0)
      for (std::size_t k = places.size(); k-- > 0;) {
        const double above = k + 1 < places.size() ? places[k + 1].first - apart : 0.98;
        places[k].first = std::min(places[k].first, above);
      }
    std::string text;
    for (const auto& [y, i] : places) {
      const Point& last = curves_[i].points.back();
      const double bar = has_bars(chart_.x) ? table_.number(last.row, chart_.x + "_high") : last.x;
      const double end = x_.share(std::isfinite(bar) ? std::max(bar, last.x) : last.x);
      if (end < 0.9)
        text +=
            fmt::format("set arrow from graph {:.4f},{:.4f} to graph 1.01,{:.4f} nohead dt 3 lw 1.2 lc rgb \"{}\"\n",
                        end + 0.015, y_.share(last.y), y, colour(i));
      text += fmt::format("set label {} at graph 1.015, graph {:.4f} left noenhanced tc rgb \"{}\"\n",
                          quoted(curves_[i].name), y, colour(i));
    }
    return text;
  }

  /// A right triangle for each slope, in the corner that curves of this slope leave free.
  std::string triangles() const {
    if (!x_.log || !y_.log) return {};
    std::string text;
    double left = 0.06;
    for (const double slope : chart_.slopes) {
      double width = 0.14;
      const double steep = slope * std::log(x_.high / x_.low) / std::log(y_.high / y_.low);
      if (std::abs(steep) * width > 0.3) width = 0.3 / std::abs(steep);
      const double height = steep * width, foot = slope < 0 ? 0.06 - height : 0.9 - height;
      const auto edge = [&](double x0, double y0, double x1, double y1) {
        return fmt::format(
            "set arrow from graph {:.4f},{:.4f} to graph {:.4f},{:.4f} nohead lw 1.2 lc rgb \"#606060\"\n", x0, y0, x1,
            y1);
      };
      text += edge(left, foot, left + width, foot + height) + edge(left, foot, left, foot + height) +
              edge(left, foot + height, left + width, foot + height);
      text += fmt::format("set label \"{:.3g}\" at graph {:.4f},{:.4f} left boxed tc rgb \"#606060\"\n", slope,
                          left + 0.35 * width, foot + 0.62 * height + (slope < 0 ? 0.05 : -0.05));
      left += width + 0.05;
    }
    return text;
  }

  /// Runs that did not end well, as crosses on the lower axis: its end in the digits of the range, or they are cut off.
  std::string failed() {
    std::string points;
    std::size_t count = 0;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      if (table_.done(row)) continue;
      ++count;
      std::vector<double> x;
      add(x, row, chart_.x, x_.log);
      if (!x.empty()) points += fmt::format("{:.10g} {:.12g}\n", x.front(), y_.low);
    }
    if (count == 0) return {};
    if (!points.empty()) points = fmt::format("$failed << EOD\n{}EOD\n", points);
    return points + fmt::format(
                        "set label \"{}{} run{} without a result\" at screen 0.99, screen 0.025 right tc rgb "
                        "\"#B00000\"\n",
                        points.empty() ? "" : "× ", count, count == 1 ? "" : "s");
  }

  /// The place of a curve among all of the table, drawn here or not: it decides colour, mark and dashes, so that a
  /// method looks the same in each chart.
  std::size_t look(std::size_t curve) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), curves_[curve].name) - names_.begin());
  }
  const char* colour(std::size_t curve) const { return colours[look(curve) % colours.size()]; }

  std::vector<std::string> names_;
  Table table_;
  Chart chart_;
  const ChartStyle& style_;
  std::vector<std::string> words_;
  std::vector<Curve> curves_;
  Axis x_, y_;
};

}  // namespace

std::string gnuplot_script(const Table& table, const Chart& chart, const ChartStyle& style) {
  return chart.color.empty() ? Drawing(table, chart, style).script() : map_script(table, chart, style);
}

std::string draw(const Table& table, const Chart& chart, const ChartStyle& style, const std::filesystem::path& folder) {
  const std::string script = chart.id + ".gp";
  write_whole(folder / script, gnuplot_script(table, chart, style));
  for (const char* format : {"format='svg'", "format='png'"}) {
    const int code = run_program({"gnuplot", "-e", format, script}, folder);
    if (code < 0) return "gnuplot is not installed (Debian package gnuplot-nox); the script stays: " + script;
    if (code > 0) return "gnuplot could not draw " + script;
  }
  return {};
}

}  // namespace msml
