// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra inside a closed surface: the meshing core behind CGALMeshVolumeFromSurface.
#pragma once
#include <optional>
#include <vector>

#include "operators/cgal_meshing.hpp"

namespace msml::operators {

/// Fills a closed, consistently oriented surface free of self-intersections with tetrahedra (CGAL Mesh_3, polyhedral
/// domain), starting from the seeds. With `feature_angle` (degrees) edges whose faces' normals differ by more are kept.
/// Sequential; the same input gives the same mesh. Regions are 1. May return a mesh without cells.
Mesh fill_surface(const Surface& surface, const std::vector<Seed>& seeds, std::optional<double> feature_angle,
                  const MeshingSettings& settings, const Watcher& watcher, const Announcer& announce);

}  // namespace msml::operators
