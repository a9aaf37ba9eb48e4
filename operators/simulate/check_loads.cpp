// SPDX-License-Identifier: GPL-3.0-or-later
// Arc length needs a load.
#include <algorithm>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

constexpr const char* loads[] = {
    "forceConstraint", "surfacePressure", "surfacePressureOnMesh", "surfaceTraction", "bodyForce", "flux", "source"};

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

}  // namespace

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
