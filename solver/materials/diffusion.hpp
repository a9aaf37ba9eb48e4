// SPDX-License-Identifier: GPL-3.0-or-later
// The law of scalar problems such as heat conduction: -div(c grad u) = f.
#pragma once
#include <functional>
#include <memory>

#include "msml/core/describe.hpp"
#include "solver/materials/law.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// One unknown u per node, whose gradient is row 0 of H. W = c/2 |grad u|^2; row 0 of P is the flux c grad u (of the
/// sign of the gradient), the rest of P is zero. `coefficient` > 0. Measures: the flux stands in row and column 0 of
/// `cauchy`, the gradient in those of `strain`. Throws Error outside the range.
std::shared_ptr<const Law> make_diffusion(double coefficient);

/// The same with one coefficient per lane, each > 0.
std::shared_ptr<const Law> make_diffusion(const Lanes& coefficients);

/// The tag `diffusionMaterial`.
Factory<std::shared_ptr<const Law>> diffusion_material();

}  // namespace msml::fe
