// SPDX-License-Identifier: GPL-3.0-or-later
// Signed polar decomposition: a fast path for eight points at once and a safe path for the rest.
#include "solver/materials/polar.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

namespace msml::fe {
namespace {

double largest(Lanes a) {
  for (int half = lanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) a[i] = a[i] > a[i + half] ? a[i] : a[i + half];
  return a[0];
}

/// One Newton step, scaled where that brings the stretches together; returns the largest change |dX|^2 in any lane.
double newton_step(Tensor<Lanes>& X, bool scaled) {
  const Tensor<Lanes> cof = cofactor(X);
  const Lanes inverse_det = 1.0 / determinant(X, cof);
  Lanes a = lanes_of(0.5), b = 0.5 * inverse_det;
  if (scaled) {
    const Lanes g = root(root(square_sum(cof) * inverse_det * inverse_det / square_sum(X)));
    a *= g;
    b /= g;
  }
  Lanes change{};
  for (int k = 0; k < 9; ++k) {
    const Lanes next = a * X.c[k] + b * cof.c[k], difference = next - X.c[k];
    change += difference * difference;
    X.c[k] = next;
  }
  return largest(change);
}

}  // namespace

Mat3 polar_rotation(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

Tensor<Lanes> polar_rotation(const Tensor<Lanes>& F) {
  // A cube has det^2 / |F|^6 = 1/27; below 1e-4 of that the iteration would lose digits.
  const Lanes norm2 = square_sum(F), det = determinant(F);
  const auto easy = (det > 0.0) & (27 * det * det > 1e-4 * norm2 * norm2 * norm2);
  const bool any_hard = !(largest(easy ? lanes_of(0) : lanes_of(1)) < 1);
  Tensor<Lanes> X = F;
  if (any_hard)
    for (int i = 0; i < lanes; ++i)
      if (!easy[i])
        for (int k = 0; k < 9; ++k) X.c[k][i] = k % 4 == 0 ? 1 : 0;
  // Convergence is quadratic: a change below 1e-8 leaves an error of 1e-16. Scaling changes nothing near the end, nor
  // where |F|^2 is nearly the 3 of rotations.
  constexpr double near = 0.3 * 0.3, done = 1e-8 * 1e-8;
  double change = newton_step(X, largest((norm2 - 3.0) * (norm2 - 3.0)) > near);
  for (int iteration = 1; iteration < 20 && !(change < done); ++iteration) change = newton_step(X, change > near);
  if (any_hard)
    for (int i = 0; i < lanes; ++i) {
      if (easy[i]) continue;
      Mat3 f;
      for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = F.c[k][i];
      const Mat3 r = f.allFinite() ? polar_rotation(f) : Mat3::Identity();
      for (int k = 0; k < 9; ++k) X.c[k][i] = r(k / 3, k % 3);
    }
  return X;
}

}  // namespace msml::fe
