// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedra with one rotation each.
#pragma once
#include <memory>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// Tet10 elements of co-rotated linear elasticity. R is the rotation nearest to the deformation gradient of the four
/// corners (polar_rotation, det R = +1 always), K (30 x 30) the stiffness of the element at rest by the four-point
/// rule: kept where edges are curved or moduli differ from point to point, otherwise made anew from few numbers (see
/// gradient_products), which takes less time than reading it. With d = R^T x - X at each node the energy is W = d^T K d
/// / 2. The force is its gradient
///   f_a = R (q_a - w x g_a),  q = K d,  w = D^-1 m,  m = sum_a d_a x q_a,  D = tr(U) I - U,
/// g_a the gradients of the corners' linear shape functions (zero at mid nodes), U = R^T F of the corners; so a free
/// element keeps its angular momentum, which f = R q alone would not. Tangents: `tangent` is the Hessian of W
/// (symmetric); `single_tangent`, `definite_tangent` and a law with tangent = rotated take R K R^T (Hauth and Strasser
/// 2004; Mueller and Gross 2004 for one rotation per element). Straight elements keep it for products, see KeptHooke.
/// Results are measured with the rotation of each point.
/// With a history (see PronyHistory) q = K d relaxes as it turns with the element, by the series at its middle: W of a
/// step is factor d^T K d / 2 + fixed . d, and all else is the same.
/// Where D is singular the polar rotation is not unique: D^-1 is bounded there. The model is checked: tet10 and
/// linearElasticMaterial, strain = corotated.
std::unique_ptr<Elements> make_single_rotation_elements(const Model& model);

}  // namespace msml::fe
