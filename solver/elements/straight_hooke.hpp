// SPDX-License-Identifier: GPL-3.0-or-later
// Hooke's law in straight quadratic tetrahedra, by the four-point rule: from few numbers, which takes less time than to
// read a stiffness matrix.
#pragma once
#include "solver/elements/shapes.hpp"
#include "solver/elements/simplex_kernels.hpp"

namespace msml::fe {

/// What the stiffness of eight such elements, of one law each, is made of. Since the law is isotropic, R K R^T is the
/// stiffness for turned gradients.
struct StraightHooke {
  Lanes inverse[9];    ///< gradients of the linear shape functions of corners 1, 2, 3
  Lanes shear, ratio;  ///< reference volume times mu, and lambda/mu
  /// Of the elements turned by R.
  StraightHooke turned(const Tensor<Lanes>& R) const;
  /// Of one of them, in all lanes.
  StraightHooke lane(int k) const;
};

/// result.force = K d (overwritten): the stresses at the points cost less than the matrix.
void apply(const StraightHooke& hooke, const NodeValues<3, 10>& d, SimplexResult<3, 10>& result);

/// Blocks (a, b), a <= b, at packed(b, a), from what gradient_products says.
void make_stiffness(const StraightHooke& hooke, Lanes (&block)[55][9]);

}  // namespace msml::fe
