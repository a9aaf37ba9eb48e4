// SPDX-License-Identifier: GPL-3.0-or-later
// chart: charts of a study drawn again, as they were or with other choices.
#include <fmt/format.h>

#include <cstdio>

#include "msml/commands/study.hpp"
#include "msml/core/formula.hpp"
#include "msml/study/saved.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;

class ChartDrawer {
 public:
  explicit ChartDrawer(const ChartArguments& arguments)
      : arguments_(arguments),
        table_(read_csv(arguments.table)),
        folder_(fs::path(arguments.table).parent_path()),
        saved_(read_charts(folder_ / "results.json").value_or(SavedCharts{})) {}

  int run() {
    std::vector<Chart> charts = chosen();
    for (Chart& chart : charts) {
      change(chart);
      check(chart);
    }
    if (faults_.empty())
      for (const Chart& chart : charts) draw_one(chart);
    for (const std::string& fault : faults_) std::fprintf(stderr, "%s\n", fault.c_str());
    return faults_.empty() ? 0 : static_cast<int>(Failure::input);
  }

 private:
  /// The saved charts, the one that is named, or a new one.
  std::vector<Chart> chosen() {
    const bool axes = !arguments_.x.empty() && !arguments_.y.empty();
    if (arguments_.chart.empty() && axes) return {Chart{.id = arguments_.y + "_over_" + arguments_.x, .where = {}}};
    if (saved_.charts.empty()) {
      faults_.push_back(
          fmt::format("{} keeps no charts: name the columns with --x and --y", (folder_ / "results.json").string()));
      return {};
    }
    if (arguments_.chart.empty()) {
      if (!arguments_.x.empty() || !arguments_.y.empty() || !arguments_.output.empty())
        faults_.emplace_back("--x, --y and -o choose one chart: give both columns, or --chart and its id");
      return saved_.charts;
    }
    std::vector<std::string> names;
    for (const Chart& chart : saved_.charts) {
      if (chart.id == arguments_.chart) return {chart};
      names.push_back(chart.id);
    }
    faults_.push_back(fmt::format("no chart is called {}{}", arguments_.chart, did_you_mean(arguments_.chart, names)));
    return {};
  }

  /// Puts what the command line says in the place of what the chart says.
  void change(Chart& chart) {
    const ChartArguments& a = arguments_;
    if (!a.x.empty()) chart.x = a.x;
    if (!a.y.empty()) chart.y = a.y;
    if (!a.title.empty()) chart.title = a.title;
    if (!a.group.empty()) chart.group = a.group;
    if (!a.scale.empty())
      chart.axes = {a.scale == "loglog" || a.scale == "logx", a.scale == "loglog" || a.scale == "logy"};
    if (!a.slopes.empty()) chart.slopes = a.slopes;
    if (!a.color.empty()) chart.color = a.color;
    if (a.accurate > 0) chart.accurate = a.accurate;
    if (a.wrong > 0) chart.wrong = a.wrong;
    if (!a.limits.empty()) chart.limits = a.limits;
    if (!a.theory.empty()) chart.theory = theory();
    if (!a.only.empty()) chart.only = only();
    if (!a.output.empty()) chart.id = fs::path(a.output).filename().replace_extension().string();
  }

  Formulas theory() {
    Formulas lines;
    for (const std::string& text : arguments_.theory) {
      const FormulaFacts facts = examine(text);
      if (!facts.problem.empty())
        faults_.push_back(fmt::format("--theory {}: {}", text, facts.problem));
      else
        lines.push_back(facts.of_position || facts.of_time ? Formula(text) : Formula(facts.value));
    }
    return lines;
  }

  Settings only() {
    Settings rows;
    for (const std::string& text : arguments_.only) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0)
        faults_.push_back(fmt::format("--only {} is not of the form name=value", text));
      else
        rows.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return rows;
  }

  void check(const Chart& chart) {
    const auto column = [&](const std::string& name, const char* what) {
      if (table_.find(name) < 0)
        faults_.push_back(fmt::format("--{}: {} has no column {}{}", what, arguments_.table, name,
                                      did_you_mean(name, table_.columns)));
    };
    column(chart.x, "x");
    if (chart.y != share_column) column(chart.y, "y");
    if (!chart.color.empty()) column(chart.color, "color");
    for (const std::string& each : chart.group) column(each, "group");
    for (const auto& [name, value] : chart.only) column(name, "only");
  }

  void draw_one(const Chart& chart) {
    const fs::path folder = arguments_.output.empty() ? folder_ : fs::path(arguments_.output).parent_path();
    try {
      if (const std::string problem = draw(table_, chart, saved_.style, folder); !problem.empty())
        faults_.push_back(problem);
    } catch (const Error& error) {
      faults_.push_back(error.str());
    }
  }

  const ChartArguments& arguments_;
  const Table table_;
  const fs::path folder_;
  const SavedCharts saved_;
  std::vector<std::string> faults_;
};

}  // namespace

int chart_command(const ChartArguments& arguments) { return ChartDrawer(arguments).run(); }

}  // namespace msml
