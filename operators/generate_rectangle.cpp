// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateRectangleMesh: a structured triangle mesh of a rectangle, as a plane body.
#include "msml/core/operator.hpp"
#include "operators/mesh_generators.hpp"
#include "operators/mesh_quadratic.hpp"

namespace msml::operators {

Operator generate_rectangle() {
  Operator op("GenerateRectangleMesh", "Make a structured triangle mesh of a rectangle in a plane of constant z.");
  const auto origin = op.parameter<std::vector<double>>("origin", {.unit = "length",
                                                                   .fallback = std::vector<double>{0, 0, 0},
                                                                   .counts = {3},
                                                                   .doc = "corner with the smallest coordinates"});
  const auto size = op.parameter<std::vector<double>>(
      "size", {.unit = "length", .range = positive(), .counts = {2}, .doc = "lengths along x and y"});
  const auto divisions = op.parameter<std::vector<Integer>>(
      "divisions", {.range = closed(1, 10000), .counts = {2}, .doc = "cells along x, y; each becomes two triangles"});
  const auto quadratic = op.parameter<bool>("quadratic", {.fallback = false, .doc = "tri6 instead of tri3"});
  const auto mesh = op.output<Mesh>("mesh", "tri3 (or tri6), counter-clockwise, and the edges as line2 (line3)");
  op.target("meshFilename", mesh, "file to write the mesh to");
  op.run([=](Context& c) {
    const auto &start = c.get(origin), &lengths = c.get(size);
    const auto& cells = c.get(divisions);
    Mesh made = generate(Rectangle{{start[0], start[1], start[2]},
                                   lengths[0],
                                   lengths[1],
                                   {static_cast<int>(cells[0]), static_cast<int>(cells[1])}});
    c.set(mesh, c.get(quadratic) ? to_quadratic(made) : std::move(made));
  });
  return op;
}

}  // namespace msml::operators
