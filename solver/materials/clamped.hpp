// SPDX-License-Identifier: GPL-3.0-or-later
// Isotropic laws continued through inversion.
#pragma once
#include <memory>

#include "msml/core/faults.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

/// The law with its energy w(s1, s2, s3) continued below a principal stretch c: along each stretch s_i < c by its
/// tangent at c, one stretch after the other, plus k (s_i - c)^2 with 2 k = 2 mu (1 - nu)/(1 - 2 nu), the stiffness of
/// Hooke's law in uniaxial strain (Stomakhin, Howes, Schroeder and Teran 2012, doi 10.2312/SCA/SCA12/025-032). Energy
/// and stress are continuous, the tangent is their derivative. The stretches are signed: the smallest has the sign of
/// det F. Where the two smallest add up to 0, the stress jumps. `law` must be isotropic; 0 < c < 1.
std::shared_ptr<const Law> make_clamped(std::shared_ptr<const Law> law, double c);

/// The attributes `inversion` and `clampedBelow`.
struct InversionKeys {
  Key<std::string> inversion;
  Key<double> below;
};
InversionKeys describe_inversion(Description& material);

/// Adds a fault where a law is to be both incompressible and clamped.
void check_inversion(const Record& record, const InversionKeys& keys, bool incompressible, Faults& faults);

/// The law, clamped where the scene asks for it. Throws Error if it is incompressible then.
std::shared_ptr<const Law> with_inversion(const Record& record, const InversionKeys& keys,
                                          std::shared_ptr<const Law> law);

}  // namespace msml::fe
