// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateBoxMesh: a structured tetrahedral mesh of a box.
#include "msml/core/operator.hpp"
#include "operators/mesh_generators.hpp"
#include "operators/mesh_quadratic.hpp"

namespace msml::operators {
namespace {

Vec3 vector(const std::vector<double>& list) { return {list[0], list[1], list[2]}; }

}  // namespace

Operator generate_box() {
  Operator op("GenerateBoxMesh", "Make a structured tetrahedral mesh of a box.");
  op.source("six tetrahedra per cell around one diagonal (Kuhn)");
  const auto origin = op.parameter<std::vector<double>>("origin", {.unit = "length",
                                                                   .fallback = std::vector<double>{0, 0, 0},
                                                                   .counts = {3},
                                                                   .doc = "corner with the smallest coordinates"});
  const auto size = op.parameter<std::vector<double>>(
      "size", {.unit = "length", .range = positive(), .counts = {3}, .doc = "lengths along x, y, z"});
  const auto divisions = op.parameter<std::vector<Integer>>(
      "divisions",
      {.range = closed(1, 1000), .counts = {3}, .doc = "cells along x, y, z; each becomes six tetrahedra"});
  const auto quadratic = op.parameter<bool>("quadratic", {.fallback = false, .doc = "tet10 instead of tet4"});
  const auto mesh = op.output<Mesh>("mesh", "tet4 (or tet10), positive volumes, region 0");
  op.target("meshFilename", mesh, "file to write the mesh to");
  op.note("Points on the faces of the box lie exactly in their planes, so that boxes with a small margin select them.");
  op.run([=](Context& c) {
    const auto& cells = c.get(divisions);
    Mesh box = generate(Box{vector(c.get(origin)),
                            vector(c.get(size)),
                            {static_cast<int>(cells[0]), static_cast<int>(cells[1]), static_cast<int>(cells[2])}});
    c.set(mesh, c.get(quadratic) ? to_quadratic(box) : std::move(box));
  });
  return op;
}

}  // namespace msml::operators
