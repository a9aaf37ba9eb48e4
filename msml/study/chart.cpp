// SPDX-License-Identifier: GPL-3.0-or-later
// Table -> gnuplot script -> SVG and PNG.
#include "msml/study/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "msml/core/atomic_file.hpp"
#include "msml/core/error.hpp"
#include "msml/core/formula.hpp"
#include "msml/run/program.hpp"
#include "msml/study/fit.hpp"

namespace msml {
namespace {

constexpr std::array<const char*, 8> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#000000", "#8C8C00"};
constexpr std::array<int, 8> marks{7, 5, 9, 11, 13, 6, 4, 8};

/// One axis: where its values lie, and how they map to 0 … 1.
struct Axis {
  bool log = false;
  double low = 0, high = 1;
  double share(double value) const {
    return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
};

Axis axis_over(std::vector<double> values, bool log, double margin) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  Axis axis{log, *least, *most};
  if (log) {
    const double pad = std::max(margin * std::log(axis.high / axis.low), 0.1);
    return {log, axis.low * std::exp(-pad), axis.high * std::exp(pad)};
  }
  double pad = margin * (axis.high - axis.low);
  if (pad == 0) pad = axis.high != 0 ? 0.1 * std::abs(axis.high) : 1;
  return {log, axis.low - pad, axis.high + pad};
}

/// A text inside double quotes of gnuplot, without markup.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    if (c == '\n')
      out += "\\n";
    else
      out += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

class Drawing {
 public:
  Drawing(const Table& table, const Chart& chart, const ChartStyle& style)
      : table_(filtered(table, chart.only)), chart_(chart), style_(style) {
    name_positions();
    if (chart_.y == share_column) add_shares();
    const bool log = chart.axes.log_x || chart.axes.log_y;
    curves_ = curves(table_, chart.x, chart.y, chart.group, log);
    if (!chart.axes.log_x || !chart.axes.log_y) keep_fitting();
    if (has_bars(chart.x)) sort_by_row();
    std::vector<double> xs, ys;
    for (const Curve& curve : curves_)
      for (const Point& point : curve.points) {
        xs.push_back(point.x), ys.push_back(point.y);
        for (const char* end : {"_low", "_high"}) {
          add(xs, point.row, chart.x + end, chart.axes.log_x);
          add(ys, point.row, chart.y + end, chart.axes.log_y);
        }
      }
    if (xs.empty())
      throw Error(fmt::format("chart '{}': no run has both {} and {} as numbers{}", chart.id, chart.x, chart.y,
                              log ? " > 0" : ""));
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (!table_.done(row)) add(xs, row, chart.x, chart.axes.log_x);
    x_ = axis_over(xs, chart.axes.log_x, 0.06);
    y_ = axis_over(ys, chart.axes.log_y, 0.08);
  }

  std::string script() {
    std::string text = head();
    for (std::size_t i = 0; i < curves_.size(); ++i) text += data(i);
    const std::string failures = failed();
    text += labels() + triangles() + limits() + theory() + failures + "plot ";
    for (std::size_t k = 0; k < chart_.theory.size(); ++k)
      text += fmt::format("$theory{} with lines lw 1.5 dt 2 lc rgb \"#707070\" notitle, \\\n     ", k);
    for (std::size_t i = 0; i < curves_.size(); ++i) text += (i == 0 ? "" : ", \\\n     ") + plot(i);
    return text +
           (failures.empty() ? "" : ", \\\n     $failed with points pt 2 ps 1.4 lw 2 lc rgb \"#B00000\" notitle") +
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

  std::string label(const std::string& column) const {
    const auto known = style_.labels.find(column);
    std::string name = column;
    std::replace(name.begin(), name.end(), '_', ' ');
    return known == style_.labels.end() ? name : known->second;
  }

  std::string head() const {
    std::string text = fmt::format(
        "# SPDX-License-Identifier: GPL-3.0-or-later\n"
        "# Drawn by gnuplot: gnuplot -e \"format='png'\" {0}.gp, or without -e for SVG.\n"
        "if (!exists(\"format\")) format = \"svg\"\n"
        "if (format eq \"png\") {{ set terminal pngcairo size 1200,840 font \"Sans,15\"; set output "
        "\"{0}.png\" }}"
        " else {{ set terminal svg size 800,560 font \"Sans,14\" background \"#ffffff\"; set output "
        "\"{0}.svg\" }}\n",
        chart_.id);
    text +=
        fmt::format("set encoding utf8\nset title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                    quoted(chart_.title), quoted(label(chart_.x)), quoted(label(chart_.y)));
    if (x_.log) text += "set logscale x\n";
    if (y_.log) text += "set logscale y\n";
    text += tics("x", x_) + tics("y", y_);
    if (!words_.empty()) {
      std::string tics;
      for (std::size_t i = 0; i < words_.size(); ++i)
        tics += fmt::format("{}{} {}", i == 0 ? "" : ", ", quoted(words_[i]), i + 1);
      text += "set xtics (" + tics + ") noenhanced\n";
    }
    return text +
           fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", x_.low, x_.high, y_.low, y_.high) +
           fmt::format(
               "set grid xtics ytics lt 1 dt 1 lw 1 lc rgb \"#D8D8D8\"\nset border 3\nset tics nomirror out\nunset "
               "key\n"
               "set rmargin {}\n",
               name_width());
  }

  /// Labels at powers of ten over more than three decades, else at 1, 2, 5, … of each.
  static std::string tics(const char* axis, const Axis& range) {
    if (!range.log) return {};
    if (range.high / range.low > 1000) return fmt::format("set format {} \"10^{{%T}}\"\n", axis);
    std::string all;
    for (int power = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10, power) <= range.high; ++power)
      for (const int digit : {1, 2, 3, 4, 5, 6, 7, 8, 9}) {
        const double value = digit * std::pow(10.0, power);
        const bool labelled = digit == 1 || digit == 2 || digit == 5 || range.high / range.low < 6;
        if (value >= range.low && value <= range.high)
          all += fmt::format("{}{} {:.6g} {}", all.empty() ? "" : ", ",
                             labelled ? fmt::format("\"{:.6g}\"", value) : "\"\"", value, labelled ? 0 : 1);
      }
    return fmt::format("set {}tics ({})\n", axis, all);
  }

  std::size_t name_width() const {
    std::size_t width = 2;
    if (curves_.size() > 1)
      for (const Curve& curve : curves_) width = std::max(width, curve.name.size() + 3);
    return std::min<std::size_t>(width, 34);
  }

  bool has_bars(const std::string& column) const { return table_.find(column + "_low") >= 0; }

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
    const char* colour = colours[i % colours.size()];
    const bool joined = style_.joined && curves_[i].points.size() > 1;
    std::string text;
    for (const auto& [column, bars] :
         {std::pair{chart_.x, "1:2:3:4 with xerrorbars"}, std::pair{chart_.y, "1:2:5:6 with yerrorbars"}})
      if (has_bars(column))
        text += fmt::format("$curve{} using {} lw 1.5 pt 0 lc rgb \"{}\" notitle, \\\n     ", i, bars, colour);
    return text + fmt::format("$curve{} using 1:2 with {} lw 2 dt {} pt {} ps 1.1 lc rgb \"{}\" notitle", i,
                              joined ? "linespoints" : "points", i / colours.size() + 1, marks[i % marks.size()],
                              colour);
  }

  /// Names at the ends of the curves, moved apart where they would overlap.
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
      const double bar = table_.number(last.row, chart_.x + "_high");
      const double end = x_.share(std::isfinite(bar) ? std::max(bar, last.x) : last.x);
      text += fmt::format("set label {} at graph {:.4f}, graph {:.4f} left offset 0.8,0 noenhanced tc rgb \"{}\"\n",
                          quoted(curves_[i].name), std::max(end, 0.0), y, colours[i % colours.size()]);
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
      text += fmt::format("set label \"{:.3g}\" at graph {:.4f},{:.4f} left tc rgb \"#606060\"\n", slope,
                          left + 0.35 * width, foot + 0.62 * height + (slope < 0 ? 0.05 : -0.05));
      left += width + 0.05;
    }
    return text;
  }

  /// Dashed lines across at the values of x that theory names.
  std::string limits() const {
    std::string text;
    for (const double x : chart_.limits)
      if (const double share = x_.log && x <= 0 ? -1 : x_.share(x); share > 0 && share < 1)
        text += fmt::format(
            "set arrow from graph {0:.4f},0 to graph {0:.4f},1 nohead lw 1.5 dt 2 lc rgb \"#707070\"\n"
            "set label \"{1:.3g}\" at graph {0:.4f}, graph 0.03 left offset 0.3,0 tc rgb \"#707070\"\n",
            share, x);
    return text;
  }

  /// Samples of the lines that theory gives, where they lie inside the chart.
  std::string theory() const {
    constexpr int samples = 200;
    std::string text;
    for (std::size_t k = 0; k < chart_.theory.size(); ++k) {
      const Function line(chart_.theory[k], "theory", {}, chart_.where);
      text += fmt::format("$theory{} << EOD\n", k);
      for (int i = 0; i <= samples; ++i) {
        const double s = static_cast<double>(i) / samples;
        const double x = x_.log ? x_.low * std::pow(x_.high / x_.low, s) : x_.low + s * (x_.high - x_.low);
        const double y = line({x, 0, 0}, 0);
        if (y >= y_.low && y <= y_.high) text += fmt::format("{:.8g} {:.8g}\n", x, y);
      }
      text += "EOD\n";
    }
    return text;
  }

  /// Runs that did not end well, as crosses on the lower axis.
  std::string failed() {
    std::string points;
    std::size_t count = 0;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      if (table_.done(row)) continue;
      ++count;
      std::vector<double> x;
      add(x, row, chart_.x, x_.log);
      if (!x.empty()) points += fmt::format("{:.10g} {:.10g}\n", x.front(), y_.low);
    }
    if (points.empty()) return {};
    return fmt::format(
        "$failed << EOD\n{}EOD\nset label \"× {} run{} without a result\" at graph 0.99, graph 0.97 right "
        "tc rgb \"#B00000\"\n",
        points, count, count == 1 ? "" : "s");
  }

  Table table_;
  Chart chart_;
  const ChartStyle& style_;
  std::vector<std::string> words_;
  std::vector<Curve> curves_;
  Axis x_, y_;
};

}  // namespace

std::string gnuplot_script(const Table& table, const Chart& chart, const ChartStyle& style) {
  return Drawing(table, chart, style).script();
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
