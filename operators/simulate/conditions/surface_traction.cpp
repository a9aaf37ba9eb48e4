// SPDX-License-Identifier: GPL-3.0-or-later
// A traction vector on boundary faces.
#include "operators/simulate/conditions/condition.hpp"

namespace msml::simulation {

ConditionFactory surface_traction() {
  ConditionFactory tag("surfaceTraction", "constraint",
                       "Force per reference area on boundary faces, which keeps its direction.");
  add_common(tag, "triangle cells of the mesh, or nodes: then the boundary faces with all corners among them");
  const auto traction = tag.parameter<Formulas>(
      "traction", {.unit = "stress", .counts = {3}, .doc = "the vector: 3 numbers or expressions"});
  const auto table = add_table(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      fe::FaceLoad load = face_load(record, traction, select_faces(record, body), false);
      load.factor = read_table(record, table);
      return {load};
    };
  });
  return tag;
}

}  // namespace msml::simulation
