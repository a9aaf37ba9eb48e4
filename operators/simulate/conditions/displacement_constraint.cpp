// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes moved to a given place.
#include "operators/simulate/conditions/condition.hpp"

namespace msml::simulation {

ConditionFactory displacement_constraint() {
  ConditionFactory tag("displacementConstraint", "constraint", "Nodes with a given total displacement.");
  add_common(tag, "the nodes; or faces or elements, whose nodes are meant");
  const auto displacement = tag.parameter<Formulas>(
      "displacement",
      {.unit = "length",
       .multiple_of = 3,
       .doc = "from the reference position: 3 numbers or expressions for all, or 3 numbers for each node"});
  const auto components = add_components(tag);
  const auto ramp = tag.parameter<std::string>(
      "ramp", {.fallback = "linear",
               .choices = {"linear", "step"},
               .doc = "linear: reached linearly from the state at the start of the step to its end; step: at once; "
                      "of no meaning with expressions in t or a table, which say what happens at each time"});
  const auto table = add_table(tag);
  tag.note("The value holds in later steps too, for nodes that no constraint and no load of a later step names.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      const auto selection = select_nodes(record, body, reporter);
      NodeValues values = per_node(record, displacement, selection, *body.mesh);
      fe::Prescribed prescribed{.name = label(record),
                                .nodes = selection.nodes,
                                .values = std::move(values.values),
                                .ramp = record[ramp] == "step" ? fe::Ramp::step : fe::Ramp::linear,
                                .function = std::move(values.function),
                                .factor = read_table(record, table)};
      read_components(record, components, prescribed);
      return {prescribed, true};
    };
  });
  return tag;
}

}  // namespace msml::simulation
