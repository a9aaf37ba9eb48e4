// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of preconditioned conjugate gradients.
#pragma once
#include <functional>

#include "solver/linear/guesses.hpp"

namespace msml::fe {

/// z = B r with B symmetric and positive definite; `size` is |r|. Both are zero at fixed unknowns.
using Preconditioning = std::function<void(const Vector& r, double size, Vector& z)>;

/// Vectors that a solution needs, kept from one to the next.
struct CgSpace {
  Vector z, p, q;
};

/// Adds to x until the recurrence of the residual r = b - A x says that it is below target, at most `limit` times
/// (Hestenes and Stiefel 1952, doi 10.6028/jres.049.044). `taken` counts. not_positive_definite where A shows it;
/// limit, too, where B alone does: round-off can take it that far where A is nearly singular.
LinearStatus conjugate_gradients(const SystemMatrix& A, const Mask& fixed, const Preconditioning& B, double target,
                                 long limit, CgSpace& space, Vector& r, Vector& x, long& taken);

}  // namespace msml::fe
