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

/// The rotations of well-conditioned points with det F > 0. The trace t of U is the largest root of t^4 - 2 |F|^2 t^2 -
/// 8 det F t + |F|^4 - 4 |cof F|^2, a simple one: there the slope is 8 d, d = (s1 + s2) (s2 + s3) (s3 + s1) of the
/// stretches. Halley's method comes to it from t^2 = (|F|^2 + 3 |cof F|^2/|F|^2) 3/2, which is t^2 to second order in
/// the differences of stretches, and where the slope and the second derivative are positive. By the
/// characteristic equation of U then d R = (t^2 + |F|^2)/2 F + t cof F - F F^T F, and |R|^2 = 3.
Tensor<Lanes> rotations(const Tensor<Lanes>& F, const Tensor<Lanes>& cof, Lanes det) {
  Lanes C[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) C[i][j] = C[j][i] = F(0, i) * F(0, j) + F(1, i) * F(1, j) + F(2, i) * F(2, j);
  const Lanes norm2 = C[0][0] + C[1][1] + C[2][2], cof2 = square_sum(cof), last = norm2 * norm2 - 4.0 * cof2;
  Lanes t = root(1.5 * norm2 + 4.5 * cof2 / norm2);
  // Convergence is cubic: a change below 3e-6 leaves an error of 3e-17, and two steps do up to strains of about 0.2.
  constexpr double done = 3e-6 * 3e-6;
  const auto step = [&] {
    const Lanes square = t * t, slope = 4.0 * ((square - norm2) * t - 2.0 * det),
                half_bend = 6.0 * square - 2.0 * norm2;
    const Lanes excess = ((square - 2.0 * norm2) * t - 8.0 * det) * t + last;
    const Lanes down = excess * slope / (slope * slope - excess * half_bend);
    t -= down;
    return largest(down * down - done * square);
  };
  step();
  for (int more = 0; more < 20 && step() > 0;) ++more;
  const Lanes of_F = 0.5 * (t * t + norm2);
  Tensor<Lanes> R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      R(i, j) = of_F * F(i, j) + t * cof(i, j) - (F(i, 0) * C[0][j] + F(i, 1) * C[1][j] + F(i, 2) * C[2][j]);
  const Lanes scale = root(3.0 / square_sum(R));  // more exact than 1/d, which knows t to a few digits less
  for (Lanes& entry : R.c) entry *= scale;
  return R;
}

}  // namespace

Mat3 polar_rotation(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

Tensor<Lanes> polar_rotation(const Tensor<Lanes>& F) {
  // A cube has det^2 / |F|^6 = 1/27; below 1e-4 of that digits would be lost.
  const Tensor<Lanes> cof = cofactor(F);
  const Lanes norm2 = square_sum(F), det = determinant(F, cof);
  const auto easy = (det > 0.0) & (27 * det * det > 1e-4 * norm2 * norm2 * norm2);
  if (largest(easy ? lanes_of(0) : lanes_of(1)) < 1) return rotations(F, cof, det);

  Tensor<Lanes> safe = F;
  for (int i = 0; i < lanes; ++i)
    if (!easy[i])
      for (int k = 0; k < 9; ++k) safe.c[k][i] = k % 4 == 0 ? 1 : 0;
  Tensor<Lanes> R = polar_rotation(safe);
  for (int i = 0; i < lanes; ++i) {
    if (easy[i]) continue;
    Mat3 f;
    for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = F.c[k][i];
    const Mat3 r = f.allFinite() ? polar_rotation(f) : Mat3::Identity();
    for (int k = 0; k < 9; ++k) R.c[k][i] = r(k / 3, k % 3);
  }
  return R;
}

}  // namespace msml::fe
