// SPDX-License-Identifier: GPL-3.0-or-later
// Signed polar decomposition: a fast path for eight points at once and a safe path for the rest.
#include "solver/materials/polar.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

namespace msml::fe {
namespace {

/// One scaled Newton step; returns the largest change of an entry in any lane.
double newton_step(Tensor<Lanes>& X) {
  const Tensor<Lanes> cof = cofactor(X);
  const Lanes inverse_det = 1.0 / determinant(X, cof);
  const Lanes inverse_norm2 = square_sum(cof) * inverse_det * inverse_det;
  const Lanes g = root(root(inverse_norm2 / square_sum(X)));
  const Lanes a = 0.5 * g, b = 0.5 * inverse_det / g;
  double change = 0;
  for (int k = 0; k < 9; ++k) {
    const Lanes next = a * X.c[k] + b * cof.c[k];
    const Lanes difference = next - X.c[k];
    for (int i = 0; i < lanes; ++i) change = std::max(change, std::abs(difference[i]));
    X.c[k] = next;
  }
  return change;
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
  bool hard[lanes], any_hard = false;
  for (int i = 0; i < lanes; ++i) {
    hard[i] = !(det[i] > 0 && 27 * det[i] * det[i] > 1e-4 * norm2[i] * norm2[i] * norm2[i]);
    any_hard = any_hard || hard[i];
  }
  Tensor<Lanes> X = F;
  if (any_hard)
    for (int i = 0; i < lanes; ++i)
      if (hard[i])
        for (int k = 0; k < 9; ++k) X.c[k][i] = k % 4 == 0 ? 1 : 0;
  // Convergence is quadratic: a change below 1e-8 leaves an error of 1e-16.
  for (int iteration = 0; iteration < 20; ++iteration)
    if (newton_step(X) < 1e-8) break;
  if (any_hard)
    for (int i = 0; i < lanes; ++i) {
      if (!hard[i]) continue;
      Mat3 f;
      for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = F.c[k][i];
      const Mat3 r = f.allFinite() ? polar_rotation(f) : Mat3::Identity();
      for (int k = 0; k < 9; ++k) X.c[k][i] = r(k / 3, k % 3);
    }
  return X;
}

}  // namespace msml::fe
