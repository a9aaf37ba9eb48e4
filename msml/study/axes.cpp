// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of gnuplot scripts.
#include "msml/study/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/core/formula.hpp"

namespace msml {
namespace {

/// Labels at powers of ten over more than three decades, else at 1, 2, 5, … of each.
std::string tics(const char* axis, const Axis& range) {
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

std::string label(const std::string& column, const ChartStyle& style) {
  const auto known = style.labels.find(column);
  std::string name = column;
  std::replace(name.begin(), name.end(), '_', ' ');
  return known == style.labels.end() ? name : known->second;
}

}  // namespace

Axis axis_over(const std::vector<double>& values, bool log, double margin) {
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

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    if (c == '\n')
      out += "\\n";
    else
      out += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string chart_head(const Chart& chart, const Frame& frame, const ChartStyle& style, std::size_t right) {
  std::string text = fmt::format(
      "# SPDX-License-Identifier: GPL-3.0-or-later\n"
      "# Drawn by gnuplot: gnuplot -e \"format='png'\" {0}.gp, or without -e for SVG.\n"
      "if (!exists(\"format\")) format = \"svg\"\n"
      "if (format eq \"png\") {{ set terminal pngcairo size 1200,840 font \"Sans,15\"; set output "
      "\"{0}.png\" }}"
      " else {{ set terminal svg size 800,560 font \"Sans,14\" background \"#ffffff\"; set output "
      "\"{0}.svg\" }}\n",
      chart.id);
  text +=
      fmt::format("set encoding utf8\nset title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                  quoted(chart.title), quoted(label(chart.x, style)), quoted(label(chart.y, style)));
  if (frame.x.log) text += "set logscale x\n";
  if (frame.y.log) text += "set logscale y\n";
  text += tics("x", frame.x) + tics("y", frame.y);
  return text +
         fmt::format("set xrange [{:.12g}:{:.12g}]\nset yrange [{:.12g}:{:.12g}]\n", frame.x.low, frame.x.high,
                     frame.y.low, frame.y.high) +
         fmt::format(
             "set grid xtics ytics lt 1 dt 1 lw 1 lc rgb \"#D8D8D8\"\nset border 3\nset tics nomirror out\nunset "
             "key\n"
             "set style textbox opaque noborder margins 0.3,0.1\nset rmargin {}\n",
             right);
}

std::string limit_lines(const Chart& chart, const Axis& x_axis) {
  std::string text;
  for (const double x : chart.limits)
    if (const double share = x_axis.log && x <= 0 ? -1 : x_axis.share(x); share > 0 && share < 1)
      text += fmt::format(
          "set arrow from graph {0:.4f},0 to graph {0:.4f},1 nohead lw 1.5 dt 2 lc rgb \"#707070\"\n"
          "set label \"{1:.3g}\" at graph {0:.4f}, graph 0.03 left offset 0.3,0 tc rgb \"#707070\"\n",
          share, x);
  return text;
}

std::string theory_lines(const Chart& chart, const Frame& frame) {
  constexpr int samples = 200;
  std::string text;
  for (std::size_t k = 0; k < chart.theory.size(); ++k) {
    const Function line(chart.theory[k], "theory", {}, chart.where);
    text += fmt::format("$theory{} << EOD\n", k);
    for (int i = 0; i <= samples; ++i) {
      const double s = static_cast<double>(i) / samples;
      const double x = frame.x.log ? frame.x.low * std::pow(frame.x.high / frame.x.low, s)
                                   : frame.x.low + s * (frame.x.high - frame.x.low);
      const double y = line({x, 0, 0}, 0);
      if (y >= frame.y.low && y <= frame.y.high) text += fmt::format("{:.8g} {:.8g}\n", x, y);
    }
    text += "EOD\n";
  }
  return text;
}

std::string theory_plots(const Chart& chart) {
  std::string text;
  for (std::size_t k = 0; k < chart.theory.size(); ++k)
    text += fmt::format("$theory{} with lines lw 1.5 dt 2 lc rgb \"#303030\" notitle, \\\n     ", k);
  return text;
}

}  // namespace msml
