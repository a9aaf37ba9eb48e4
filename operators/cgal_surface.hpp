// SPDX-License-Identifier: GPL-3.0-or-later
// What CGAL knows about triangle surfaces: self-intersections, edge collapse, nearest points.
#pragma once
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Pairs of triangles that meet elsewhere than in a shared corner or edge; a triangle without area is paired with
/// itself. The surface must be a manifold with consistent orientation.
std::vector<std::pair<int, int>> self_intersections(const Surface& surface);

/// Throws Error with counts and a place unless the surface, after repair(), bounds a volume: closed, manifold, free of
/// self-intersections.
void refuse_unless_closed(const Surface& surface);

/// When to stop collapsing edges; exactly one is set.
struct CollapseTarget {
  std::optional<long> edges, vertices;
};

/// Collapses edges, cheapest first (Lindstrom-Turk cost and placement: Fast and memory efficient polygonal
/// simplification, 1998), until fewer than the wanted edges, or no more than the wanted vertices, are left, or no edge
/// can go. Edges with both ends in the box (low, high corner) stay. The surface must be a manifold.
Surface collapse_edges(const Surface& surface, CollapseTarget target, std::optional<std::pair<Vec3, Vec3>> keep);

/// Finds nearest points on a surface.
class NearestPoint {
 public:
  explicit NearestPoint(const Surface& surface);
  ~NearestPoint();
  NearestPoint(const NearestPoint&) = delete;
  NearestPoint& operator=(const NearestPoint&) = delete;
  Vec3 operator()(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace msml::operators
