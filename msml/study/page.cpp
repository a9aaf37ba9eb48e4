// SPDX-License-Identifier: GPL-3.0-or-later
// What a study found, in words and tables.
#include "msml/study/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "msml/study/costs.hpp"
#include "msml/study/extrapolate.hpp"
#include "msml/study/readings.hpp"

namespace msml {
namespace {

using Cells = std::vector<std::vector<std::string>>;

std::string digits(double x) { return fmt::format("{:.4g}", x); }

class Writer {
 public:
  Writer(const Study& study, const Table& table) : study_(study), table_(table) {}

  Page write(const std::string& about, const ChartProblems& problems) {
    heading(study_.title.empty() ? study_.id : study_.title);
    paragraph(about + " " + outcome());
    for (const Chart& chart : study_.charts) {
      const auto problem = problems.find(chart.id);
      if (problem == problems.end())
        add({Block::Kind::picture, chart.id, {}});
      else
        paragraph(fmt::format("Chart {} is not drawn: {}", chart.id, problem->second));
    }
    for (const Page& part : {slope_blocks(study_, table_), passing_blocks(study_, table_), cost_blocks(study_, table_)})
      for (const Block& block : part) add(block);
    if (study_.combine == Combine::latin_hypercube) spread();
    sharing();
    without_limit();
    failures();
    heading("All runs");
    Cells cells{{table_.columns.begin(), table_.columns.end() - 2}};
    for (const auto& row : table_.rows) cells.emplace_back(row.begin(), row.end() - 2);
    table(std::move(cells));
    return std::move(page_);
  }

 private:
  void add(Block block) { page_.push_back(std::move(block)); }
  void heading(const std::string& text) { add({Block::Kind::heading, text, {}}); }
  void paragraph(const std::string& text) { add({Block::Kind::paragraph, text, {}}); }
  void table(Cells cells) { add({Block::Kind::table, "", std::move(cells)}); }

  std::string outcome() const {
    std::map<std::string, int> counts;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) ++counts[table_.text(row, "status")];
    std::string text = fmt::format("{} runs:", table_.rows.size());
    for (const auto& [status, count] : counts) text += fmt::format(" {} {},", count, status);
    text.back() = '.';
    return text;
  }

  void spread() {
    Cells cells{{"measure", "runs", "mean", "standard deviation", "5 %", "median", "95 %"}};
    for (const Measure& m : study_.measures) {
      std::vector<double> values;
      for (std::size_t row = 0; row < table_.rows.size(); ++row)
        if (const double x = table_.number(row, m.id); table_.done(row) && std::isfinite(x)) values.push_back(x);
      if (values.size() < 2) continue;
      std::sort(values.begin(), values.end());
      const double n = static_cast<double>(values.size());
      double mean = 0, square = 0;
      for (const double x : values) mean += x / n;
      for (const double x : values) square += (x - mean) * (x - mean) / (n - 1);
      const auto quantile = [&](double q) {
        const double place = q * (n - 1);
        const auto i = static_cast<std::size_t>(place);
        const double next = values[std::min(i + 1, values.size() - 1)];
        return digits(values[i] + (place - static_cast<double>(i)) * (next - values[i]));
      };
      cells.push_back({m.id, std::to_string(values.size()), digits(mean), digits(std::sqrt(square)), quantile(0.05),
                       quantile(0.5), quantile(0.95)});
    }
    heading("Spread");
    table(std::move(cells));
  }

  /// What a run costs with what other runs computed, and without.
  void sharing() {
    const auto median_of = [&](const char* what) {
      std::vector<double> values;
      for (const Measure& m : study_.measures)
        for (std::size_t row = 0; row < table_.rows.size() && m.quantity == Quantity::time && m.what == what; ++row)
          if (const double x = table_.number(row, m.id); table_.done(row) && std::isfinite(x)) values.push_back(x);
      std::sort(values.begin(), values.end());
      return values.empty() ? 0 : values[values.size() / 2];
    };
    const double on = median_of("run"), off = median_of("apart");
    if (on <= 0 || off <= 0) return;
    heading("What sharing saves");
    paragraph(
        fmt::format("Median over the runs, by the clock: {} s with sharing on, {} s with sharing off, where every "
                    "run was made once more and computed all of its nodes itself: {:.2f} times.",
                    digits(on), digits(off), off / on));
  }

  /// Where cells of errors against an extrapolated limit stay empty, and why.
  void without_limit() {
    Cells cells{{"measure", "of the runs with", "why"}};
    Table copy = table_;
    for (const NoLimit& each : extrapolate(study_, copy))
      cells.push_back({each.measure, each.others.empty() ? "all" : each.others, each.why});
    if (cells.size() == 1) return;
    heading("Errors without a limit");
    paragraph(
        fmt::format("No limit over {} was found for these, so their errors stay empty.", study_.truth->extrapolate));
    table(std::move(cells));
  }

  void failures() {
    Cells cells{study_.variables()};
    cells.front().insert(cells.front().end(), {"status", "reason"});
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      if (table_.done(row)) continue;
      cells.emplace_back();
      for (const std::string& column : cells.front()) cells.back().push_back(table_.text(row, column));
    }
    if (cells.size() == 1) return;
    heading("Runs without a result");
    table(std::move(cells));
  }

  const Study& study_;
  const Table& table_;
  Page page_;
};

}  // namespace

Page make_page(const Study& study, const Table& table, const std::string& about, const ChartProblems& problems) {
  return Writer(study, table).write(about, problems);
}

}  // namespace msml
