// SPDX-License-Identifier: GPL-3.0-or-later
// ExtractPointPositions: coordinates of chosen points.
#include <fmt/format.h>

#include "msml/core/operator.hpp"

namespace msml::operators {

Operator extract_point_positions() {
  Operator op("ExtractPointPositions", "Coordinates of the points with the given ids.");
  op.source("MSML 2015");
  const auto indices = op.input<IndexSet>("indices", {.indexes = Indexed::nodes, .doc = "ids of nodes"});
  const auto mesh = op.input<Mesh>("mesh", "whose points they are");
  const auto points = op.output<std::vector<double>>("points", "x1 y1 z1 x2 y2 z2 …, in the order of the ids");
  op.run([=](Context& c) {
    const IndexSet& set = c.get(indices);
    const Mesh& source = c.get(mesh);
    if (set.kind != Indexed::nodes)
      throw Error(fmt::format("indices are ids of {}, but ExtractPointPositions needs ids of nodes", name(set.kind)));
    std::vector<double> positions;
    for (const int id : set.ids) {
      if (id < 0 || id >= source.point_count())
        throw Error(
            fmt::format("indices name point {}, but the mesh has points 0 to {}", id, source.point_count() - 1));
      for (int d = 0; d < 3; ++d) positions.push_back(source.points(id, d));
    }
    c.set(points, std::move(positions));
  });
  return op;
}

}  // namespace msml::operators
