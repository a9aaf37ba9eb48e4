// SPDX-License-Identifier: GPL-3.0-or-later
// From straight linear cells to quadratic ones.
#pragma once
#include <functional>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Place of the mid node of an edge between two points.
using MidPoint = std::function<Vec3(const Vec3& a, const Vec3& b)>;

/// line2, tri3 and tet4 become line3, tri6 and tet10 with one mid node per edge, shared by all its cells; points keep
/// their ids, mid nodes follow. Cells keep order, regions and fields; point fields at mid nodes are the mean of the
/// ends. Cells that are quadratic already, and vertices, stay. Without `mid` edges stay straight.
Mesh to_quadratic(const Mesh& mesh, const MidPoint& mid = {});

struct Projection {
  long moved = 0;          ///< mid nodes placed on the surface
  long kept_straight = 0;  ///< mid nodes left where they were because an element would have been inverted
  double farthest = 0;     ///< largest distance moved
};

/// Moves the mid nodes of edges of the outer faces of tet10 cells to where `nearest` sends them. Then, as long as the
/// Jacobian of an element may vanish somewhere (Bernstein bound not above 1 % of its mean), the edges of that element
/// go back to straight. Elements that were no better before are left alone.
Projection project_mid_nodes(Mesh& mesh, const std::function<Vec3(const Vec3&)>& nearest);

}  // namespace msml::operators
