// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that slide in planes.
#include <cmath>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

std::string normal_problem(const Value& value) {
  const auto& n = std::get<std::vector<double>>(value);
  return n.size() == 3 && n[0] == 0 && n[1] == 0 && n[2] == 0 ? "0 0 0 has no direction" : "";
}

ConditionFactory sliding(const char* name, const std::string& doc) {
  ConditionFactory tag(name, "constraint", doc);
  add_common(tag, "the nodes; or faces or elements, whose nodes are meant");
  const auto normal = tag.parameter<std::vector<double>>(
      "normal", {.counts = {3}, .check = normal_problem, .doc = "of the plane, of any length and sign but 0 0 0"});
  tag.note("symmetryPlane and roller are the same condition under two names.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      const Vec3 n(record[normal][0], record[normal][1], record[normal][2]);
      const std::vector<int> nodes = select_nodes(record, body, reporter).nodes;
      const int axis = axis_of(n);
      if (axis < 0) return {fe::Slide{.name = label(record), .nodes = nodes, .normal = n.normalized()}};
      fe::Prescribed held{.name = label(record), .nodes = nodes, .values = {Vec3::Zero()}, .ramp = fe::Ramp::step};
      for (int k = 0; k < 3; ++k) held.components[k] = k == axis;
      return {held};
    };
  });
  return tag;
}

}  // namespace

int axis_of(const Vec3& normal) {
  for (int k = 0; k < 3; ++k)
    if ((normal.normalized() - Vec3::Unit(k)).norm() < 1e-12 || (normal.normalized() + Vec3::Unit(k)).norm() < 1e-12)
      return k;
  return -1;
}

ConditionFactory symmetry_plane() {
  return sliding("symmetryPlane", "Nodes that stay in planes with a normal: they slide freely along them.");
}

ConditionFactory roller() { return sliding("roller", "Nodes on rollers: held along a normal, free across it."); }

}  // namespace msml::simulation
