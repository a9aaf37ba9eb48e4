// SPDX-License-Identifier: GPL-3.0-or-later
// What the two CGAL volume meshers share: their criteria as settings and as attributes of the language.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "msml/core/operator.hpp"

namespace msml::operators {

/// Criteria of Delaunay refinement and the passes that follow it. Lengths in the units of the input.
struct MeshingSettings {
  double facet_angle = 25;    ///< lower bound of the angles of surface triangles, degrees; 0 = none, at most 30
  double facet_size = 0;      ///< upper bound of the radius of a surface triangle's circumscribing ball, > 0
  double facet_distance = 0;  ///< upper bound of the distance between triangle and surface, > 0
  double radius_edge = 2;     ///< upper bound of circumradius over shortest edge of a tetrahedron; 2 and above ends
  double cell_size = 0;       ///< upper bound of the circumradius of a tetrahedron, > 0
  bool odt = false, lloyd = false, perturb = false, exude = false;
};

/// Called now and then with the points placed so far, while refinement lasts.
using Watcher = std::function<void(std::size_t points)>;
/// Called with the name of each pass as it begins, and with `cut_short` once more where pass_patience ended it.
using Announcer = std::function<void(const std::string& pass, bool cut_short)>;
/// Seconds: on few points between protected edges exudation can go round for ever.
constexpr double pass_patience = 120;

/// A segment known to cross the surface: refinement starts from the crossing, unless a point is nearer than `clear`.
struct Seed {
  Vec3 from, to;
  double clear = 0;
};

/// Handles to the attributes that both meshers take.
struct MeshingKeys {
  Key<double> facet_angle, facet_size, facet_distance, radius_edge, cell_size;
  Key<bool> odt, lloyd, perturb, exude;
};

/// Adds the attributes facetAngle … exude, with their ranges and defaults, to an operator.
MeshingKeys describe_meshing(Operator& op);

/// The settings a scene gives. Where a length is absent it follows from the diagonal of the bounding box: facetSize and
/// cellSize 1/30 of it, facetDistance 1/10 of facetSize. Warns where refinement is not known to end.
MeshingSettings meshing_settings(Context& context, const MeshingKeys& keys, double diagonal);

/// A watcher that reports progress in points, out of an estimate from the volume of the body and the cell size. With a
/// radius-edge bound below 2 it throws Error when there are 50 times as many (at least 100,000), so that nothing hangs.
Watcher progress_in_points(Reporter& reporter, double volume, const MeshingSettings& settings);
/// Reports each pass as progress, and as a warning where it was cut short.
Announcer announce_passes(Reporter& reporter);

}  // namespace msml::operators
