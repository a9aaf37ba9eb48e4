// SPDX-License-Identifier: GPL-3.0-or-later
// Arc length needs a load, and what is pushed in statics needs a hold.
#include <algorithm>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

constexpr const char* loads[] = {
    "forceConstraint", "surfacePressure", "surfacePressureOnMesh", "surfaceTraction", "bodyForce", "flux", "source"};

constexpr const char* holders[] = {"fixedConstraint", "displacementConstraint", "symmetryPlane", "roller",
                                   "spring",          "springToPoint",          "fixedValue",    "springMeshToFixed"};

bool zero(const Formula& formula) { return formula.constant() && formula.number == 0; }

/// False if all numbers of the tag are known to be 0.
bool pulls(const Record& record) {
  for (const Value& value : record.values) {
    const auto* one = std::get_if<Formula>(&value);
    const auto* list = std::get_if<Formulas>(&value);
    if ((one != nullptr && !zero(*one)) || (list != nullptr && !std::ranges::all_of(*list, zero))) return true;
  }
  return false;
}

/// What an unsaid gravity does is along z, which plane bodies and lines do not feel.
bool weighs(const Record& step, const Surroundings& around) {
  if (around.scalar == true) return false;
  const int slot = step.description->find("gravity");
  const bool solid = around.kind == CellKind::vertex || dimension(*around.kind) == 3;
  return slot < 0 || (!step.given[static_cast<std::size_t>(slot)] ? solid : pulls(step));
}

/// A condition that may pull in the step of a name.
bool pulls_in(const Placed& placed, const std::string& step) {
  return (placed.step.empty() || placed.step == step) &&
         std::ranges::find(loads, placed.record->tag()) != std::end(loads) && pulls(*placed.record);
}

/// Numbers that do not change, not all 0 along the first axes: they push a body as a whole.
bool pushes(const Record& record, int axes = 3) {
  const int table = record.description->find("table");
  if (table >= 0 && type(record.values[static_cast<std::size_t>(table)]) != Type::nothing) return false;
  bool some = false;
  for (const Value& value : record.values) {
    const auto* one = std::get_if<Formula>(&value);
    const auto* list = std::get_if<Formulas>(&value);
    const Formulas all = list != nullptr ? *list : one != nullptr ? Formulas{*one} : Formulas{};
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!all[k].constant()) return false;
      some = some || (static_cast<int>(k) < axes && all[k].number != 0);
    }
  }
  return some;
}

/// Something may hold the body in a step: in it, or in an earlier one as displacements do.
bool may_hold(const std::vector<Placed>& conditions, const std::vector<std::string>& names, std::size_t step) {
  return std::ranges::any_of(conditions, [&](const Placed& placed) {
    if (std::ranges::find(holders, placed.record->tag()) == std::end(holders)) return false;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(step) + 1;
    return placed.step.empty() || placed.step == names[step] ||
           (placed.record->tag() == "displacementConstraint" && std::find(names.begin(), end, placed.step) != end);
  });
}

/// Loads of one sign on the whole of the body, and none else: gravity, or one source.
bool pushed(const Record& step, const std::string& name, const std::vector<Placed>& conditions,
            const Surroundings& around) {
  std::vector<const Record*> acting;
  for (const Placed& placed : conditions)
    if (pulls_in(placed, name)) acting.push_back(placed.record);
  if (around.scalar == true) return acting.size() == 1 && acting[0]->tag() == "source" && pushes(*acting[0]);
  const int slot = step.description->find("gravity");
  return acting.empty() && weighs(step, around) &&
         (!step.given[static_cast<std::size_t>(slot)] ||
          pushes(step, *around.kind == CellKind::vertex ? 3 : dimension(*around.kind)));
}

}  // namespace

void check_held(const Record& args, const Surroundings& around, const fe::Tell& tell) {
  if (!around.kind || !around.scalar || around.settings == nullptr || fe::is_dynamic(around.settings->integrator))
    return;
  const std::vector<const Record*> steps = all_of(args, "step");
  const std::vector<std::string> names = step_names(args);
  const std::vector<Placed> conditions = placed_conditions(args);
  for (std::size_t s = 0; s < steps.size(); ++s)
    if (!may_hold(conditions, names, s) && pushed(*steps[s], names[s], conditions, around))
      tell(fault_of(*steps[s], *around.scalar
                                   ? "the source feeds a stationary problem that nothing drains: give a fixedValue, or "
                                     "a flux that takes as much away"
                                   : "gravity pulls, but nothing holds the body, which is static: give a "
                                     "fixedConstraint or springs, gravity=\"0 0 0\", or a dynamic timeIntegration"));
}

void check_arc_loads(const Record& args, const Surroundings& around, const fe::Tell& tell) {
  const Record* solver = first_of(args, "solver");
  if (solver == nullptr || !around.kind || around.settings == nullptr || !around.settings->arc_length.on ||
      around.settings->integrator != fe::Integrator::static_)
    return;
  const std::vector<const Record*> steps = all_of(args, "step");
  const std::vector<std::string> names = step_names(args);
  const std::vector<Placed> conditions = placed_conditions(args);
  for (std::size_t s = 0; s < steps.size(); ++s) {
    check_timeless(*steps[s], tell);
    const bool loaded = std::ranges::any_of(conditions, [&](const Placed& p) { return pulls_in(p, names[s]); });
    if (loaded || weighs(*steps[s], around)) continue;
    const std::string what = "arcLength scales the loads, but there is none";
    tell(steps.size() == 1 ? fault_of(*solver, what + ": give a load, or take arcLength=\"false\"")
                           : fault_of(*steps[s], what + " in this step: give it one, or take arcLength=\"false\""));
  }
}

}  // namespace msml::simulation
