// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients.
#include "solver/linear/cg.hpp"

#include <cmath>

#include "solver/pieces.hpp"

namespace msml::fe {

namespace {

/// q = A p at free unknowns, 0 at fixed ones; returns p . q.
double multiply_free(const SystemMatrix& A, const Mask& fixed, const Vector& p, Vector& q) {
  if (!A.numbers) A.products->multiply(p, q);
  return sum_pieces<short_piece>(p.size(), [&](long first, long last) {
    if (A.numbers) multiply(*A.numbers, static_cast<int>(first / 3), static_cast<int>(last / 3), p, q);
    for (long k = first; k < last; ++k)
      if (fixed[static_cast<std::size_t>(k)]) q[k] = 0;
    return p.segment(first, last - first).dot(q.segment(first, last - first));
  });
}

}  // namespace

LinearStatus conjugate_gradients(const SystemMatrix& A, const Mask& fixed, const Preconditioning& B, double target,
                                 long limit, CgSpace& space, Vector& r, Vector& x, long& taken) {
  Vector &z = space.z, &p = space.p, &q = space.q;
  z.resize(r.size());
  q.resize(r.size());
  p = Vector::Zero(r.size());
  double rho_before = 1, size = std::sqrt(dot(r, r));
  while (taken < limit) {
    B(r, size, z);
    const double rho = dot(r, z);
    if (!(rho > 0))
      return multiply_free(A, fixed, z, q) > 0 ? LinearStatus::limit : LinearStatus::not_positive_definite;
    for_pieces(p.size(), [&, beta = rho / rho_before](long, long first, long last) {
      const long count = last - first;
      p.segment(first, count) = z.segment(first, count) + beta * p.segment(first, count);
    });
    rho_before = rho;
    const double curvature = multiply_free(A, fixed, p, q);
    if (!(curvature > 0)) return LinearStatus::not_positive_definite;
    size = std::sqrt(sum_pieces(p.size(), [&, alpha = rho / curvature](long first, long last) {
      const long count = last - first;
      x.segment(first, count) += alpha * p.segment(first, count);
      r.segment(first, count) -= alpha * q.segment(first, count);
      return r.segment(first, count).squaredNorm();
    }));
    ++taken;
    if (size <= target) return LinearStatus::done;
  }
  return LinearStatus::limit;
}

}  // namespace msml::fe
