// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateSphereMesh: a structured tetrahedral mesh of a ball or hollow sphere.
#include <fmt/format.h>

#include "msml/core/operator.hpp"
#include "operators/early_checks.hpp"
#include "operators/mesh_generators.hpp"

namespace msml::operators {
namespace {

Key<Integer> count(Operator& op, const std::string& name, Integer fallback, const std::string& doc) {
  return op.parameter<Integer>(name, {.range = closed(1, 500), .fallback = fallback, .doc = doc});
}

}  // namespace

Operator generate_sphere() {
  Operator op("GenerateSphereMesh",
              "Make a structured tetrahedral mesh of a ball or hollow sphere, or of an eighth of it.");
  op.source("hexahedra on the six sides of a cube, each cut into tetrahedra");
  const auto center = op.parameter<std::vector<double>>(
      "center", {.unit = "length", .fallback = std::vector<double>{0, 0, 0}, .counts = {3}, .doc = "of the sphere"});
  const auto radius = op.parameter<double>("radius", {.unit = "length", .range = positive(), .doc = "outer radius"});
  const auto inner = op.parameter<double>(
      "innerRadius", {.unit = "length", .range = nonnegative(), .fallback = 0.0, .doc = "of the cavity; 0 = full"});
  const auto around = count(op, "around", 4, "divisions of 45 degrees of a great circle");
  const auto across = count(op, "across", 4, "divisions from the cavity or the core to the outside");
  const auto octant = op.parameter<bool>(
      "octant",
      {.fallback = false,
       .doc = "only the part with x, y and z at or above the centre; the three cuts lie exactly in their planes"});
  const auto quadratic =
      op.parameter<bool>("quadratic", {.fallback = false, .doc = "tet10 with mid nodes on the curved surface"});
  const auto mesh = op.output<Mesh>("mesh", "tet4 (or tet10), positive volumes, region 0");
  op.target("meshFilename", mesh, "file to write the mesh to");
  run_checked(op, radii_in_order(inner, radius), [=](Context& c) {
    const auto& o = c.get(center);
    const Sphere sphere{.centre = Vec3(o[0], o[1], o[2]),
                        .radius = c.get(radius),
                        .inner = c.get(inner),
                        .around = static_cast<int>(c.get(around)),
                        .across = static_cast<int>(c.get(across)),
                        .octant = c.get(octant)};
    c.set(mesh, c.get(quadratic) ? generate_quadratic(sphere) : generate(sphere));
  });
  return op;
}

}  // namespace msml::operators
