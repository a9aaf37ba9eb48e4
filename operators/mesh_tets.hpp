// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra of a mesh: their corners, volumes, outer faces, and the Jacobian of curved ones.
#pragma once
#include <array>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// True for tet4 and tet10.
bool is_tet(CellKind kind);

/// Throws Error naming the operator unless the mesh holds a tetrahedron.
void require_tets(const Mesh& mesh, const char* operation);

/// Corners 0..3 of a tet4 or tet10 as rows.
Eigen::Matrix<double, 4, 3> corners_of(const Mesh& mesh, int cell);

/// Signed volume of the tetrahedron of the corners: det(p1 - p0, p2 - p0, p3 - p0) / 6.
double volume(const Eigen::Matrix<double, 4, 3>& corners);

/// A face that one tetrahedron alone has.
struct OuterFace {
  int cell = -1, local = -1;  ///< local: index into msml::tet_faces
};

/// Outer faces of all tet4 and tet10 cells, by cell, then by local face. Throws Error where three or more share a face.
std::vector<OuterFace> outer_faces(const Mesh& mesh);

/// det of dx/dxi of a tet10 at a point xi of the reference tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1).
double jacobian(const Eigen::Matrix<double, 10, 3>& nodes, const Vec3& xi);

/// Smallest Bernstein coefficient of the cubic polynomial det dx/dxi of a tet10: a lower bound of it over the element
/// (convex hull property), so a positive value proves that the element is nowhere inverted.
double jacobian_bound(const Eigen::Matrix<double, 10, 3>& nodes);

/// Nodes 0..9 of a tet10 as rows.
Eigen::Matrix<double, 10, 3> nodes_of(const Mesh& mesh, int cell);

/// Volume of the curved element: the integral of the cubic det dx/dxi, exactly (mean of its Bernstein coefficients).
double curved_volume(const Eigen::Matrix<double, 10, 3>& nodes);

}  // namespace msml::operators
