// SPDX-License-Identifier: GPL-3.0-or-later
// Arc length needs a load.
#include <algorithm>

#include "operators/simulate/build_model.hpp"
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

}  // namespace

void check_arc_loads(const Record& args, const Surroundings& around) {
  const Record* solver = first_of(args, "solver");
  if (solver == nullptr || !around.kind || around.settings == nullptr || !around.settings->arc_length.on ||
      around.settings->integrator != fe::Integrator::static_)
    return;
  for (const Record* step : all_of(args, "step"))
    if (weighs(*step, around)) return;
  for (const Record* condition : all_of(args, "constraint"))
    if (condition->tag().starts_with("spring"))
      return;  // those that change in time pull
    else if (std::ranges::find(loads, condition->tag()) != std::end(loads) && pulls(*condition))
      return;
  refuse(*solver, "arcLength scales the loads, but there is none: give a load, or take arcLength=\"false\"");
}

}  // namespace msml::simulation
