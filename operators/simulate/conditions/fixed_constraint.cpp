// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes held where they are.
#include "operators/simulate/conditions/condition.hpp"

namespace msml::simulation {

ConditionFactory fixed_constraint() {
  ConditionFactory tag("fixedConstraint", "constraint", "Nodes that do not move: zero displacement.");
  add_common(tag, "the nodes; or faces or elements, whose nodes are meant");
  const auto components = add_components(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      fe::Prescribed prescribed{.name = label(record),
                                .nodes = select_nodes(record, body, reporter).nodes,
                                .values = {Vec3::Zero()},
                                .ramp = fe::Ramp::step};
      read_components(record, components, prescribed);
      return {prescribed};
    };
  });
  return tag;
}

}  // namespace msml::simulation
