// SPDX-License-Identifier: GPL-3.0-or-later
// Values, fluxes and sources of scalar problems.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

/// A number as the first component of a vector.
fe::VectorFunction first_component(const Function& value) {
  return [value](const Vec3& X, double t) { return Vec3(value(X, t), 0, 0); };
}

}  // namespace

ConditionFactory fixed_value() {
  ConditionFactory tag("fixedValue", "constraint", "Nodes of a scalar problem with a given value.");
  add_common(tag, "the nodes; or faces or elements, whose nodes are meant");
  const auto value = tag.parameter<Formula>("value", {.doc = "a number or an expression"});
  const auto table = add_table(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      const Function function = msml::function(record, value);
      fe::Prescribed held{.name = label(record),
                          .nodes = select_nodes(record, body, reporter).nodes,
                          .components = {true, false, false},
                          .ramp = fe::Ramp::step,
                          .factor = read_table(record, table)};
      if (function.of_time())
        held.function = first_component(function);
      else
        for (const int node : held.nodes)
          held.values.emplace_back(function(body.mesh->points.row(node).transpose(), 0), 0, 0);
      return {held};
    };
  });
  return tag;
}

ConditionFactory flux() {
  ConditionFactory tag("flux", "constraint", "What flows into the body of a scalar problem through boundary faces.");
  add_common(tag, "cells on the boundary, or nodes: then the boundary faces with all corners among them");
  const auto value =
      tag.parameter<Formula>("value", {.doc = "c du/dn per area, positive inwards of a positive source"});
  const auto table = add_table(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const Function function = msml::function(record, value);
      fe::FaceLoad load{
          .name = label(record), .faces = select_faces(record, body).faces, .factor = read_table(record, table)};
      load.steady = !function.of_time();
      if (function.constant())
        load.tractions = {first_component(function)(Vec3::Zero(), 0)};
      else
        load.traction_function = first_component(function);
      return {load};
    };
  });
  return tag;
}

ConditionFactory source() {
  ConditionFactory tag("source", "constraint", "What is fed into a scalar problem per volume.");
  const auto indices = tag.input<IndexSet>(
      "indices", {.optional = true, .indexes = Indexed::elements, .doc = "the elements; absent: the whole body"});
  const auto value = tag.parameter<Formula>("value", {.doc = "f of -div(c grad u) = f: a number or an expression"});
  const auto table = add_table(tag);
  tag.parameter<std::string>(
      "forStep", {.optional = true, .doc = "name of the step it acts in; absent: as the constraint around it says"});
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const Function function = msml::function(record, value);
      fe::BodyForce load{.name = label(record), .elements = body.elements, .factor = read_table(record, table)};
      if (record.has(indices)) load.elements = select_elements(record, body);
      if (load.elements.empty())
        refuse(record, fmt::format("indices holds no element; the body spans {}", bounds(body)));
      load.steady = !function.of_time();
      if (function.constant())
        load.value = first_component(function)(Vec3::Zero(), 0);
      else
        load.function = first_component(function);
      return {load};
    };
  });
  return tag;
}

}  // namespace msml::simulation
