// SPDX-License-Identifier: GPL-3.0-or-later
// Any law under plane stress.
#pragma once
#include <memory>

#include "solver/materials/law.hpp"

namespace msml::fe {

/// The law with H_33 free: W(H) = min over H_33 of the law's own W, so that P_33 = 0; H_13, H_23, H_31 and H_32 are
/// zero and the tangent is condensed, A - A_33 A_33^T / A_3333 (de Borst 1991, doi 10.1108/eb023825). H_33 is found by
/// Newton's method at each point, safeguarded by halved steps, from H_33 of the gradients where it helps. Works for
/// laws that keep those four shears of P zero in plane deformations: isotropic ones, and fibres in the plane or across
/// it. Throws Error for others.
std::shared_ptr<const Law> make_plane_stress(std::shared_ptr<const Law> law);

/// F_33 of a law under plane stress, and its derivative by F_ik of the plane at 3 i + k.
struct Thinning {
  Lanes stretch;
  Lanes slope[9];
};

/// Of a law that does not know of plane stress itself, at gradients in the plane. dF_33/dF = -A_33 / A_3333 from P_33 =
/// 0.
Thinning thinning(const Law& law, const Gradients& gradient);

}  // namespace msml::fe
