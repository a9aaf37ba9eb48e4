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

/// Angle of a rotation matrix in degrees, accurate near 0 and near 180.
double rotation_angle(const Mat3& R);

}  // namespace msml::fe
