// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on nodes.
#include <fmt/format.h>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {

ConditionFactory force_constraint() {
  ConditionFactory tag("forceConstraint", "constraint", "A force on every node, which keeps its direction.");
  add_common(tag, "the nodes; or faces or elements, whose nodes are meant");
  const auto force =
      tag.parameter<Formulas>("force", {.unit = "force",
                                        .multiple_of = 3,
                                        .doc = "3 numbers or expressions, for every node, or 3 numbers for each node"});
  const auto table = add_table(tag);
  tag.note("The force acts on every node in full; it is not shared between them. For a load by area: surfaceTraction.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      const auto selection = select_nodes(record, body, reporter);
      const auto lost = static_cast<std::size_t>(selection.listed) - selection.nodes.size();
      if (!selection.positions.empty() && lost > 0)
        reporter.warn(
            fmt::format("{}: no force acts on {} of the {} in indices, which belong to no element; name nodes of "
                        "the body",
                        located(record), with_commas(static_cast<long long>(lost)), counted(selection.listed, "node")));
      NodeValues values = per_node(record, force, selection, *body.mesh);
      return {fe::NodalForce{.name = label(record),
                             .nodes = selection.nodes,
                             .values = std::move(values.values),
                             .function = std::move(values.function),
                             .factor = read_table(record, table)}};
    };
  });
  return tag;
}

}  // namespace msml::simulation
