// SPDX-License-Identifier: GPL-3.0-or-later
// Reads PLY polygons; CGAL's and VTK's readers do not survive damaged headers.
#pragma once
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Corners and polygons of a PLY file.
struct PlyPolygons {
  std::vector<Vec3> points;
  std::vector<std::vector<long long>> faces;  ///< point ids, not checked
};

/// Reads x, y, z of the element "vertex" and the list "vertex_indices" (or "vertex_index") of the element "face";
/// ASCII, binary little and big endian. Other elements and properties are skipped. Throws Error where the file is cut
/// off.
PlyPolygons read_ply(const std::string& file);

}  // namespace msml::operators
