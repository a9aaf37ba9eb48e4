// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra without height at the boundary, which meshers leave on plane faces.
#pragma once
#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Removes tet4 cells flatter than 1e-4 of the cube of their longest edge that lie in the boundary with two or three
/// faces, where the boundary stays a manifold; the body changes by less than 1e-3 of an edge there. Points that lose
/// all cells go. Returns how many cells went. The mesh must be of tet4 cells without fields.
long drop_flat(Mesh& mesh);

/// Cells still flatter than that.
long count_flat(const Mesh& mesh);

}  // namespace msml::operators
