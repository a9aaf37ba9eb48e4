// SPDX-License-Identifier: GPL-3.0-or-later
// Load curves that end before they act, or begin after.
#include <algorithm>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/idle_attributes.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

/// When each step starts, and when the last one ends; empty if a length is not known.
std::vector<double> times_of(const std::vector<const Record*>& steps) {
  std::vector<double> times{0};
  for (const Record* step : steps) {
    const auto* dt = value_of<double>(*step, "dt");
    const auto* count = value_of<Integer>(*step, "iterations");
    if (dt == nullptr || count == nullptr) return {};
    times.push_back(times.back() + *dt * static_cast<double>(*count));
  }
  return times;
}

/// `from` to `to`: when the tag may act.
void look_at(const Record& record, double from, double to, const std::function<void(const Error&)>& tell) {
  const auto* table = value_of<std::vector<double>>(record, "table");
  if (table == nullptr || table->size() < 4) return;
  const double first = table->front(), last = (*table)[table->size() - 2];
  if (first < to && last > from) return;
  tell(Error(fmt::format("{}: the times of its table, {:g} to {:g}, lie outside of {:g} to {:g}, when it acts: its "
                         "factor is {:g} all the time. Check the times, and dt and iterations of the steps",
                         record.tag(), first, last, from, to, first < to ? table->back() : (*table)[1]),
             record.where));
}

}  // namespace

void find_idle_tables(const Record& args, const std::function<void(const Error&)>& tell) {
  const std::vector<const Record*> steps = all_of(args, "step");
  const std::vector<std::string> names = step_names(args);
  const std::vector<double> times = times_of(steps);
  if (times.empty()) return;
  for (std::size_t s = 0; s < steps.size(); ++s) look_at(*steps[s], times[s], times[s + 1], tell);
  for (const Placed& placed : placed_conditions(args)) {
    const auto found = std::ranges::find(names, placed.step);
    if (!placed.step.empty() && found == names.end()) continue;  // it never acts
    const auto first = placed.step.empty() ? 0 : found - names.begin();
    look_at(*placed.record, times[static_cast<std::size_t>(first)], times.back(), tell);
  }
}

}  // namespace msml::simulation
