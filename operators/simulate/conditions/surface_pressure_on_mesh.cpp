// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure on the faces of the body that coincide with triangles of a separate surface.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

std::string no_pulse(const Value&) {
  return "it is not available yet; a table or an expression in t gives the pressure over time";
}

}  // namespace

ConditionFactory surface_pressure_on_mesh() {
  ConditionFactory tag("surfacePressureOnMesh", "constraint",
                       "Pressure on the boundary faces that lie on triangles of a separate surface mesh.");
  const auto mesh =
      tag.input<Mesh>("mesh",
                      "the surface: its triangles are matched with the faces by place; of quadratic elements the "
                      "four triangles through mid nodes, as ExtractSurfaceMesh makes them, are one face");
  add_common(tag, "triangle cells of that surface, or its nodes", Indexed::faces);
  const auto pressure = tag.parameter<Formulas>(
      "pressure",
      {.unit = "stress",
       .doc = "one number or expression, one number per face (four triangles of a face with mid nodes count "
              "once, where the last of them is named), or three: a traction vector per reference area"});
  const auto table = add_table(tag);
  tag.parameter<std::string>("pulse", {.optional = true, .check = no_pulse, .doc = "not available yet"});
  const auto follower = tag.parameter<bool>("follower", {.optional = true, .doc = "as in surfacePressure"});
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const bool follow = follows(record, follower, record[pressure], body);
      fe::FaceLoad load = face_load(record, pressure, select_faces_on(record, body, record[mesh]), follow);
      load.factor = read_table(record, table);
      return {load};
    };
  });
  return tag;
}

}  // namespace msml::simulation
