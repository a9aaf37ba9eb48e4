// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateSegmentMesh: equal elements on a segment of the x direction.
#include "msml/core/operator.hpp"
#include "operators/mesh_generators.hpp"
#include "operators/mesh_quadratic.hpp"

namespace msml::operators {

Operator generate_segment() {
  Operator op("GenerateSegmentMesh", "Make a mesh of equal line elements along x.");
  const auto origin = op.parameter<std::vector<double>>(
      "origin",
      {.unit = "length", .fallback = std::vector<double>{0, 0, 0}, .counts = {3}, .doc = "end with the smallest x"});
  const auto length = op.parameter("length", {.unit = "length", .range = positive(), .doc = "along x"});
  const auto divisions = op.parameter<Integer>("divisions", {.range = closed(1, 1000000), .doc = "elements"});
  const auto quadratic = op.parameter<bool>("quadratic", {.fallback = false, .doc = "line3 instead of line2"});
  const auto mesh = op.output<Mesh>("mesh", "line2 (or line3) from small to large x, and the ends as vertices");
  op.target("meshFilename", mesh, "file to write the mesh to");
  op.run([=](Context& c) {
    const auto& start = c.get(origin);
    Mesh made = generate(Segment{{start[0], start[1], start[2]}, c.get(length), static_cast<int>(c.get(divisions))});
    c.set(mesh, c.get(quadratic) ? to_quadratic(made) : std::move(made));
  });
  return op;
}

}  // namespace msml::operators
