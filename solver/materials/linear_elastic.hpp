// SPDX-License-Identifier: GPL-3.0-or-later
// Linear elasticity, in small strain or co-rotated with each point.
#pragma once
#include <memory>

#include "msml/core/describe.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

enum class Strain { small, corotated };
enum class TangentKind { automatic, exact, rotated };

/// What defines the law.
struct LinearElastic {
  double youngs_modulus = 3000;  ///< stress, > 0
  double poisson_ratio = 0.3;    ///< in (-1, 0.5)
  Strain strain = Strain::corotated;
  /// Corotated only: exact = derivative of the stress; rotated = R K R^T, which leaves out dR/dF; automatic = exact,
  /// but rotated with one linear solve per step.
  TangentKind tangent = TangentKind::automatic;
  bool continued = false;  ///< corotated: states that are inside out are gone through, where the rotation jumps
};

/// The law. With Lame's mu and lambda:
/// small:     W = mu e:e + lambda/2 (tr e)^2,           e = sym H, sigma = P = 2 mu e + lambda tr(e) I;
/// corotated: W = mu |U - I|^2 + lambda/2 tr(U - I)^2,  F = R U with det R = +1 always (see polar_rotation),
///            P = R (2 mu (U - I) + lambda tr(U - I) I); Cauchy stress is written as P R^T.
/// dR/dF by Chen and Wheeler 1993, doi 10.1007/BF00042491. Throws Error outside the ranges.
std::shared_ptr<const Law> make_linear_elastic(const LinearElastic& data);

/// The tag `linearElasticMaterial`.
Factory<std::shared_ptr<const Law>> linear_elastic_material();

}  // namespace msml::fe
