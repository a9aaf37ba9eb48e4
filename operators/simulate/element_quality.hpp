// SPDX-License-Identifier: GPL-3.0-or-later
// The worst element of a body.
#pragma once
#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// Shape of a straight tetrahedron.
struct Shape {
  double smallest_angle = 0;  ///< dihedral, degrees; 70.53 in the regular one
  double radius_ratio = 0;    ///< 3 r_in / R_out: 1 in the regular one, 0 where flat
};

/// From the four corners. r_in = 3 V / A; R_out from the Cayley-Menger relation of opposite edge products
/// (24 V R)^2 = (p+q+r)(p+q-r)(p-q+r)(-p+q+r), where p, q, r are the products of opposite edges.
Shape tetrahedron_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// From the three corners: the smallest angle (60 degrees in the regular one) and 2 r_in / R_out.
Shape triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c);

/// The worst of the body in its reference positions, corners only. Lines have no shape: 180 degrees and 1.
struct WorstShape {
  double smallest_angle = 180;  ///< dihedral of tetrahedra
  int angle_element = -1;
  double radius_ratio = 1;
  int ratio_element = -1;
};
WorstShape worst_shape(const Body& body);

}  // namespace msml::simulation
