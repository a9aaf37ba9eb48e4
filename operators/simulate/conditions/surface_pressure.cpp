// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure on boundary faces of the body's own mesh.
#include "operators/simulate/conditions/condition.hpp"

namespace msml::simulation {

ConditionFactory surface_pressure() {
  ConditionFactory tag("surfacePressure", "constraint",
                       "Pressure on boundary faces; positive pushes against the outward normal.");
  add_common(tag, "triangle cells of the mesh, or nodes: then the boundary faces with all corners among them");
  const auto pressure = tag.parameter<Formulas>(
      "pressure", {.unit = "stress",
                   .doc = "one number or expression, one number per face, or three: a traction vector per reference "
                          "area"});
  const auto table = add_table(tag);
  const auto follower = tag.parameter<bool>(
      "follower", {.optional = true,
                   .doc = "true: acts on the deformed face; absent: true, except where every law is of small strains"});
  tag.note("Triangles with points of their own are matched with the faces of the tetrahedra by place.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const bool follow = follows(record, follower, record[pressure], body);
      fe::FaceLoad load = face_load(record, pressure, select_faces(record, body), follow);
      load.factor = read_table(record, table);
      return {load};
    };
  });
  return tag;
}

}  // namespace msml::simulation
