// SPDX-License-Identifier: GPL-3.0-or-later
// Displacements and velocities at the start of the simulation.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

std::string time_problem(const Value& value) {
  for (const Formula& formula : std::get<Formulas>(value))
    if (!formula.constant() && examine(formula.text).of_time)
      return fmt::format("'{}' depends on t, but the start has one time; use X, Y and Z", formula.text);
  return {};
}

ConditionFactory initial(const char* name, const char* attribute, const char* unit, bool velocity) {
  ConditionFactory tag(name, "constraint", std::string("The ") + attribute + " of nodes at the start.");
  tag.input<IndexSet>("indices", {.optional = true,
                                  .doc = "the nodes; or faces or elements, whose nodes are meant; absent: all nodes"});
  const auto value = tag.parameter<Formulas>(
      attribute, {.unit = unit,
                  .multiple_of = 3,
                  .check = time_problem,
                  .doc = "3 numbers or expressions in X, Y and Z for all, or 3 numbers for each node"});
  tag.note("It acts once, before the first step; a later tag overwrites an earlier one at the nodes that both name.");
  tag.note(
      "Dynamics of incompressible regions refuse one that changes volumes; what the mesh makes of one that keeps them "
      "is "
      "taken away.");
  if (!velocity) tag.note("A static simulation takes it as the start of Newton's method in the first step.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      NodeSelection selection;
      if (record.values[0].index() != 0) {
        selection = select_nodes(record, body, reporter);
      } else {
        for (int n = 0; n < body.mesh->point_count(); ++n)
          if (body.solid[static_cast<std::size_t>(n)]) selection.nodes.push_back(n);
      }
      NodeValues values = per_node(record, value, selection, *body.mesh);
      if (values.values.size() == 1) values.values.assign(selection.nodes.size(), Vec3(values.values.front()));
      return {InitialState{.velocity = velocity, .nodes = selection.nodes, .values = std::move(values.values)}};
    };
  });
  return tag;
}

}  // namespace

ConditionFactory initial_velocity() { return initial("initialVelocity", "velocity", "length/time", true); }
ConditionFactory initial_displacement() { return initial("initialDisplacement", "displacement", "length", false); }

}  // namespace msml::simulation
