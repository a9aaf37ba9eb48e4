// SPDX-License-Identifier: GPL-3.0-or-later
// Is a triangle surface the boundary of a volume? What can be put right without loss, and what is wrong.
#pragma once
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"
#include "msml/core/operator.hpp"

namespace msml::operators {

/// Faults of connectivity.
struct SoupFaults {
  long border_edges = 0;          ///< edges with one triangle
  long nonmanifold_edges = 0;     ///< edges with three or more
  long nonmanifold_vertices = 0;  ///< vertices whose triangles do not form one fan
  bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0; }
  /// "3 border edges, 1 non-manifold edge", or "".
  std::string str() const;
};

/// What repair() did.
struct SoupRepairs {
  long merged_points = 0, dropped_triangles = 0, unused_points = 0, turned_triangles = 0;
};

/// Merges points with equal coordinates, drops triangles without three distinct corners, repeated triangles and unused
/// points, and turns the minority of each part so that neighbours agree. Fields are dropped where they no longer fit.
/// Throws Error for a one-sided (Moebius) surface.
Surface repair(const Surface& surface, SoupRepairs& done);

/// Tells in verbose mode what repair() did.
void note_repairs(Reporter& reporter, const SoupRepairs& done);

SoupFaults faults(const Surface& surface);

/// Connected part (over shared edges) of each triangle, numbered from 0.
std::vector<int> parts_of(const Surface& surface);

/// Volume enclosed by a closed surface, negative where it is turned inside out (divergence theorem).
double enclosed_volume(const Surface& surface);

}  // namespace msml::operators
