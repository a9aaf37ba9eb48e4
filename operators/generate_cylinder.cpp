// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateCylinderMesh: a structured tetrahedral mesh of a cylinder or tube.
#include <fmt/format.h>

#include "msml/core/operator.hpp"
#include "operators/early_checks.hpp"
#include "operators/mesh_generators.hpp"

namespace msml::operators {
namespace {

Key<Integer> count(Operator& op, const std::string& name, Integer fallback, const std::string& doc) {
  return op.parameter<Integer>(name, {.range = closed(1, 1000), .fallback = fallback, .doc = doc});
}

}  // namespace

Operator generate_cylinder() {
  Operator op("GenerateCylinderMesh", "Make a structured tetrahedral mesh of a cylinder or tube along z.");
  op.source("hexahedra around a square core, each cut into tetrahedra");
  const auto origin = op.parameter<std::vector<double>>(
      "origin",
      {.unit = "length", .fallback = std::vector<double>{0, 0, 0}, .counts = {3}, .doc = "centre of the base"});
  const auto radius = op.parameter<double>("radius", {.unit = "length", .range = positive(), .doc = "outer radius"});
  const auto inner = op.parameter<double>(
      "innerRadius", {.unit = "length", .range = nonnegative(), .fallback = 0.0, .doc = "of the hole; 0 = full"});
  const auto height = op.parameter<double>("height", {.unit = "length", .range = positive(), .doc = "length along z"});
  const auto around = count(op, "around", 4, "divisions of 45 degrees");
  const auto across = count(op, "across", 4, "divisions from the hole or the core to the outside");
  const auto along = count(op, "along", 4, "divisions of the height");
  const auto quarter =
      op.parameter<bool>("quarter", {.fallback = false, .doc = "only the part with x and y at or above the axis"});
  const auto quadratic =
      op.parameter<bool>("quadratic", {.fallback = false, .doc = "tet10 with mid nodes on the curved surface"});
  const auto mesh = op.output<Mesh>("mesh", "tet4 (or tet10), positive volumes, region 0");
  op.target("meshFilename", mesh, "file to write the mesh to");
  run_checked(op, radii_in_order(inner, radius), [=](Context& c) {
    const auto& o = c.get(origin);
    const Cylinder cylinder{.origin = Vec3(o[0], o[1], o[2]),
                            .radius = c.get(radius),
                            .inner = c.get(inner),
                            .height = c.get(height),
                            .around = static_cast<int>(c.get(around)),
                            .across = static_cast<int>(c.get(across)),
                            .along = static_cast<int>(c.get(along)),
                            .quarter = c.get(quarter)};
    c.set(mesh, c.get(quadratic) ? generate_quadratic(cylinder) : generate(cylinder));
  });
  return op;
}

}  // namespace msml::operators
