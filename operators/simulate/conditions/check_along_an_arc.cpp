// SPDX-License-Identifier: GPL-3.0-or-later
// What arc length does not follow.
#include <algorithm>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

bool zero(const Formula& formula) { return formula.constant() && formula.number == 0; }
bool timed(const Formula& formula) { return !formula.constant() && examine(formula.text).of_time; }

/// Some node is moved, at no time in particular, along an axis that the tag holds.
bool moves(const Record& record, const Formulas& displacement) {
  if (std::ranges::any_of(displacement, timed)) return false;
  const auto* words = value_of<Words>(record, "components");
  for (std::size_t i = 0; i < displacement.size(); ++i)
    if (!zero(displacement[i]) &&
        (words == nullptr || std::ranges::find(*words, std::string(1, "xyz"[i % 3])) != words->end()))
      return true;
  return false;
}

}  // namespace

void check_timeless(const Record& record, const fe::Tell& tell) {
  const auto& slots = record.description->slots();
  const auto look = [&](const Slot& slot, const Formula& formula) {
    if (timed(formula))
      tell(fault_of(record, fmt::format("{} = {} depends on t, but arcLength follows the load and knows no time: leave "
                                        "t out, or take arcLength=\"false\"",
                                        slot.name, shortened(formula.text))));
  };
  for (std::size_t s = 0; s < slots.size(); ++s) {
    if (const auto* one = std::get_if<Formula>(&record.values[s])) look(slots[s], *one);
    if (const auto* list = std::get_if<Formulas>(&record.values[s]))
      for (const Formula& each : *list) look(slots[s], each);
  }
  if (value_of<std::vector<double>>(record, "table") != nullptr)
    tell(fault_of(record,
                  "table changes with time, but arcLength follows the load and knows none: leave the table out, or "
                  "take arcLength=\"false\""));
}

void check_along_an_arc(const Record& condition, const fe::Tell& tell) {
  check_timeless(condition, tell);
  const auto* normal = value_of<std::vector<double>>(condition, "normal");
  if (normal != nullptr && normal->size() == 3 && axis_of(Vec3((*normal)[0], (*normal)[1], (*normal)[2])) < 0)
    tell(
        fault_of(condition,
                 "its plane is askew, which arcLength does not follow: turn the scene so that the normal lies along an "
                 "axis, or take arcLength=\"false\""));
  const auto* value = condition.tag() == "fixedValue" ? value_of<Formula>(condition, "value") : nullptr;
  if (value != nullptr && !zero(*value) && !timed(*value))
    tell(fault_of(condition,
                  "moves the unknown, but arcLength follows loads alone: take value=\"0\", or arcLength=\"false\""));
  const auto* displacement =
      condition.tag() == "displacementConstraint" ? value_of<Formulas>(condition, "displacement") : nullptr;
  if (displacement != nullptr && moves(condition, *displacement))
    tell(fault_of(
        condition,
        "moves supports, but arcLength follows loads alone: let the supports stay, or take arcLength=\"false\""));
}

}  // namespace msml::simulation
