// SPDX-License-Identifier: GPL-3.0-or-later
// Fills closed surfaces with voxels.
#pragma once
#include <string>

#include "msml/core/image.hpp"
#include "msml/core/mesh.hpp"

namespace msml::operators {

/// How the triangles meet, after points at the same place are joined.
struct Seams {
  int open = 0;               ///< edges of one triangle only
  int crowded = 0;            ///< edges of more than two triangles
  Vec3 where = Vec3::Zero();  ///< the middle of the first open (else crowded) edge
};
Seams seams_of(const Surface& surface);

/// Caps every hole with triangles (vtkFillHolesFilter); points at the same place are joined.
Surface without_holes(const Surface& surface);

/// An empty grid of cubes of edge `voxel` around the surface and `margin` on all sides, centred, with one more layer of
/// voxels all around, so that the outside is connected. Voxels are zero (uint8).
/// Throws Error for an empty surface and for more than 2^31 voxels.
Image grid_around(const Surface& surface, double voxel, double margin);

/// The longest side of the axis-parallel bounding box. Throws Error for an empty surface or one without extent.
double longest_side(const Surface& surface);

/// 255 in the voxels whose centre lies inside the surface, else 0, on the grid of `grid` (turned or not).
/// The surface is closed; where parts overlap, the inside is where a line from outside has crossed it an odd number of
/// times.
Image filled(const Surface& surface, const Image& grid);

}  // namespace msml::operators
