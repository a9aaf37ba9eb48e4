// SPDX-License-Identifier: GPL-3.0-or-later
// How an element is deformed, independent of its material.
#pragma once
#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// Of one element, over its quadrature points.
struct Deformation {
  double volume = 0, deformed_volume = 0;  ///< integrals of 1 and of det F
  double smallest_J = std::numeric_limits<double>::infinity();
  double largest_strain = 0;    ///< largest absolute principal value of U - I
  double largest_rotation = 0;  ///< angle of the polar rotation, degrees
};
/// Of a scalar problem nothing deforms.
Deformation deformation(const ElementPoints& points, bool scalar = false);

/// (grad u + grad u^T)/2 of a state, whatever the law: #cells x 6, xx yy zz xy yz xz, means over the quadrature points;
/// zero for cells without unknowns.
std::vector<double> small_strains(const Model& model, const State& state);

/// Angle of a rotation matrix in degrees, accurate near 0 and near 180.
double rotation_angle(const Mat3& R);

}  // namespace msml::fe
