// SPDX-License-Identifier: GPL-3.0-or-later
// Hooke's law at the points of quadratic tetrahedra: from few numbers, which takes less time than to read a stiffness
// matrix.
#pragma once
#include "solver/elements/shapes.hpp"
#include "solver/elements/simplex_kernels.hpp"

namespace msml::fe {

/// What the stiffness at one of the four points of eight elements is made of. Since the law is isotropic, that of an
/// element turned by R is the same with turned gradients.
struct HookePoint {
  Lanes inverse[9];     ///< dxi/dX row by row: the gradients of the linear shape functions of corners 1, 2, 3
  Lanes weight, ratio;  ///< reference volume of the point times mu, and lambda/mu
  HookePoint turned(const Tensor<Lanes>& R) const;
  /// Of one of the elements, in all lanes.
  HookePoint lane(int k) const;
};

/// result.force = K d (overwritten), with the same numbers at all points or their own at each. The stresses at the
/// points cost less than the matrix.
template <std::size_t distinct>
void apply(const std::array<HookePoint, distinct>& points, const NodeValues<3, 10>& d, SimplexResult<3, 10>& result);

/// Blocks (a, b), a <= b, at packed(b, a), with the same numbers at all points; from what gradient_products says.
void make_stiffness(const HookePoint& all, Lanes (&block)[55][9]);

}  // namespace msml::fe
