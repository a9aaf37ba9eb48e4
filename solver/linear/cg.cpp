// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients.
#include "solver/linear/cg.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

namespace msml::fe {

void zero_fixed(const Mask& fixed, Vector& v) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, v.size(), 8192), [&](const auto& range) {
    for (Eigen::Index k = range.begin(); k < range.end(); ++k)
      if (fixed[static_cast<std::size_t>(k)]) v[k] = 0;
  });
}

void start_near(const BlockMatrix& A, const Mask& fixed, const Vector& b, const Vector& guess, Vector& r, Vector& x) {
  r = b;
  x = Vector::Zero(b.size());
  if (guess.size() != b.size()) return;
  Vector p = guess, q;
  zero_fixed(fixed, p);
  multiply(A, p, q);
  zero_fixed(fixed, q);
  const double curvature = dot(p, q), share = dot(p, b) / curvature;
  if (!(curvature > 0) || !std::isfinite(share)) return;
  x = share * p;
  r -= share * q;
}

LinearStatus conjugate_gradients(const BlockMatrix& A, const Mask& fixed, const Preconditioning& B, double target,
                                 long limit, CgSpace& space, Vector& r, Vector& x, long& taken) {
  auto& [z, p, q] = space;
  z.resize(r.size());
  p = Vector::Zero(r.size());
  double rho_before = 1, size = std::sqrt(dot(r, r));
  while (taken < limit) {
    B(r, size, z);
    const double rho = dot(r, z);
    if (!(rho > 0)) return LinearStatus::not_positive_definite;
    p = z + (rho / rho_before) * p;
    rho_before = rho;
    multiply(A, p, q);
    zero_fixed(fixed, q);
    const double curvature = dot(p, q);
    if (!(curvature > 0)) return LinearStatus::not_positive_definite;
    x += (rho / curvature) * p;
    r -= (rho / curvature) * q;
    ++taken;
    size = std::sqrt(dot(r, r));
    if (size <= target) return LinearStatus::done;
  }
  return LinearStatus::limit;
}

}  // namespace msml::fe
