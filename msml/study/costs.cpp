// SPDX-License-Identifier: GPL-3.0-or-later
// Fronts, cheapest settings, and ratios at the same error.
#include "msml/study/costs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "msml/study/fit.hpp"

namespace msml {
namespace {

using Cells = std::vector<std::vector<std::string>>;

constexpr double levels[] = {0.1, 0.05, 0.01, 0.001};
constexpr double compared_levels[] = {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};

std::string digits(double x) { return fmt::format("{:.4g}", x); }
std::string percent(double x) { return fmt::format("{:.4g} %", 100 * x); }

/// An error, the rows it is looked at in, and the methods that are compared there.
struct Subject {
  std::string error, name;
  Settings only;
  std::vector<std::string> group;
  bool weighed = false;  ///< a chart puts it over what it costs; else other runs may be other problems
};

std::vector<Subject> subjects(const Study& study) {
  std::vector<Subject> found;
  for (const Measure& m : study.measures) {
    if (!m.against_truth || !m.relative) continue;
    for (const Chart& chart : study.charts) {
      if (chart.y != m.id) continue;
      const auto variables = study.variables();
      const bool weighed = std::find(variables.begin(), variables.end(), chart.x) == variables.end();
      const auto seen = std::find_if(found.begin(), found.end(), [&](const Subject& each) {
        return each.error == m.id && each.only == chart.only;
      });
      if (seen != found.end()) {
        seen->weighed = seen->weighed || weighed;
        continue;
      }
      found.push_back({m.id, m.id, chart.only, chart.group, weighed});
      for (const auto& [name, value] : chart.only) found.back().name += fmt::format(", {} = {}", name, value);
    }
    if (std::none_of(found.begin(), found.end(), [&](const Subject& each) { return each.error == m.id; }))
      found.push_back({m.id, m.id, {}, {}, true});
  }
  return found;
}

class Costs {
 public:
  Costs(const Study& study, const Table& table, const Subject& subject, Page& page)
      : study_(study), table_(filtered(table, subject.only)), subject_(subject), page_(page) {}

  void add() {
    if (subject_.weighed) front();
    if (subject_.weighed) cheapest();
    ratios();
  }

 private:
  void heading(const std::string& text) { page_.push_back({Block::Kind::heading, text, {}}); }
  void paragraph(const std::string& text) { page_.push_back({Block::Kind::paragraph, text, {}}); }
  void table(Cells cells) { page_.push_back({Block::Kind::table, "", std::move(cells)}); }

  /// The measure of time that accuracy is weighed against, or null.
  const Measure* time() const {
    for (const Measure& m : study_.measures)
      if (m.quantity == Quantity::time) return &m;
    return nullptr;
  }

  void front() {
    if (!time()) return;
    Cells cells{{fmt::format("{} [s]", time()->id), subject_.error}};
    for (const std::string& name : study_.variables()) cells.front().push_back(name);
    for (const Curve& curve : curves(table_, time()->id, subject_.error, {}, true))
      for (const Point& point : pareto_front(curve.points)) {
        cells.push_back({digits(point.x), percent(point.y)});
        for (const std::string& name : study_.variables()) cells.back().push_back(table_.text(point.row, name));
      }
    if (cells.size() == 1) return;
    heading(fmt::format("Pareto front: {} against {}", subject_.name, time()->id));
    paragraph("No other run is both faster and more accurate than these.");
    table(std::move(cells));
  }

  void cheapest() {
    const std::string cost = time() ? time()->id : "unknowns";
    Cells cells{{"error at most", cost, subject_.error}};
    for (const std::string& name : study_.variables()) cells.front().push_back(name);
    for (const double level : levels) {
      const Point* best = nullptr;
      const auto all = curves(table_, cost, subject_.error, {}, true);
      for (const Curve& curve : all)
        for (const Point& point : curve.points)
          if (point.y <= level && (!best || point.x < best->x)) best = &point;
      cells.push_back({percent(level), best ? digits(best->x) : "not reached", best ? percent(best->y) : ""});
      for (const std::string& name : study_.variables())
        cells.back().push_back(best ? table_.text(best->row, name) : "");
    }
    heading(fmt::format("Cheapest setting: {}", subject_.name));
    table(std::move(cells));
  }

  void ratios() {
    const auto& group = subject_.group;
    if (group.empty()) return;
    std::vector<std::string> costs;
    const auto all = curves(table_, "unknowns", subject_.error, {}, true);
    if (!all.empty() && all[0].points.front().x < all[0].points.back().x) costs.emplace_back("unknowns");
    if (time()) costs.push_back(time()->id);
    Cells cells{{"error", "method"}};
    for (const std::string& cost : costs) cells.front().insert(cells.front().end(), {cost, "to the best"});
    for (const double level : compared_levels) {
      Cells rows;
      for (const std::string& name : distinct(table_, group)) rows.push_back({percent(level), name});
      bool any = false;
      for (const std::string& cost : costs) any = add_costs(group, cost, level, rows) || any;
      std::erase_if(rows, [](const auto& row) {
        return std::all_of(row.begin() + 2, row.end(), [](const std::string& text) { return text.empty(); });
      });
      if (any && rows.size() > 1) cells.insert(cells.end(), rows.begin(), rows.end());
    }
    if (cells.size() == 1) return;
    heading(fmt::format("What each method needs for the same {}", subject_.name));
    paragraph(
        "Between runs by straight lines in the logarithms, for errors that the runs of at least two methods bracket.");
    table(std::move(cells));
  }

  bool add_costs(const std::vector<std::string>& group, const std::string& cost, double level, Cells& rows) const {
    std::map<std::string, double> needed;
    double best = 0;
    for (Curve& curve : curves(table_, cost, subject_.error, group, true)) {
      // As in the table, from coarse to fine: a time that is disturbed must not change the order.
      std::sort(curve.points.begin(), curve.points.end(), [](const Point& a, const Point& b) { return a.row < b.row; });
      if (const auto x = reaches(curve.points, level)) {
        needed[curve.name] = *x;
        best = best == 0 ? *x : std::min(best, *x);
      }
    }
    for (auto& row : rows) {
      const auto found = needed.find(row[1]);
      row.push_back(found == needed.end() ? "" : digits(found->second));
      row.push_back(found == needed.end() ? "" : fmt::format("{:.2f}", found->second / best));
    }
    return !needed.empty();
  }

  const Study& study_;
  const Table table_;
  const Subject& subject_;
  Page& page_;
};

}  // namespace

Page cost_blocks(const Study& study, const Table& table) {
  Page page;
  for (const Subject& subject : subjects(study)) Costs(study, table, subject, page).add();
  return page;
}

}  // namespace msml
