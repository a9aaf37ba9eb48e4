// SPDX-License-Identifier: GPL-3.0-or-later
// Force per volume.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {

ConditionFactory body_force() {
  ConditionFactory tag("bodyForce", "constraint", "Force per reference volume, which keeps its direction.");
  const auto indices = tag.input<IndexSet>(
      "indices", {.optional = true, .indexes = Indexed::elements, .doc = "the elements; absent: the whole body"});
  const auto force = tag.parameter<Formulas>(
      "force", {.unit = "force/volume", .counts = {3}, .doc = "the vector: 3 numbers or expressions"});
  const auto table = add_table(tag);
  tag.parameter<std::string>(
      "forStep", {.optional = true, .doc = "name of the step it acts in; absent: as the constraint around it says"});
  tag.note("For a force per mass there is the gravity of a step.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const std::vector<Function> parts = functions(record, force);
      fe::BodyForce load{.name = label(record), .elements = body.elements, .factor = read_table(record, table)};
      if (record.has(indices)) load.elements = select_elements(record, body);
      if (load.elements.empty())
        refuse(record, fmt::format("indices holds no element; the body spans {}", bounds(body)));
      load.steady = true;
      for (const Function& part : parts) load.steady = load.steady && !part.of_time();
      const bool constant = parts[0].constant() && parts[1].constant() && parts[2].constant();
      if (constant)
        load.value = vector_of(parts)(Vec3::Zero(), 0);
      else
        load.function = vector_of(parts);
      return {load};
    };
  });
  return tag;
}

}  // namespace msml::simulation
