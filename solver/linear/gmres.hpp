// SPDX-License-Identifier: GPL-3.0-or-later
// Unsymmetric systems that are close to a symmetric one with a factorisation.
#pragma once
#include <functional>

#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// y = A x.
using LinearMap = std::function<void(const Vector& x, Vector& y)>;

/// Solves A x = b on the free unknowns by flexible GMRES (Saad 1993, doi 10.1137/0914028), preconditioned by `nearby`,
/// which is factorised and may be iterative itself. x is 0 at fixed unknowns; |b - A x| <= tolerance |b| on return of
/// done, or where round-off forbids that, as small as it gets and below 1e-4 |b|. limit: 400 iterations were not
/// enough. Each iteration costs one product and one solve with `nearby`.
LinearStatus solve_unsymmetric(const LinearMap& A, LinearSystem& nearby, const Mask& fixed, const Vector& b,
                               double tolerance, Vector& x);

}  // namespace msml::fe
