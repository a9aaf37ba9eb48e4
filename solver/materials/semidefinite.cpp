// SPDX-License-Identifier: GPL-3.0-or-later
// Projection of 9 x 9 tangents onto the positive semidefinite ones.
#include "solver/materials/semidefinite.hpp"

#include <Eigen/Eigenvalues>

#include "solver/materials/invariants.hpp"

namespace msml::fe {
namespace {

using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Which lanes are positive semidefinite up to round-off: a Cholesky factorisation of the slightly shifted tangent.
Lanes smallest_pivot(const Lanes* A) {
  Lanes L[45], trace{}, smallest = lanes_of(1);
  for (int i = 0; i < 9; ++i) trace += A[packed_at(i, i)];
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) {
      Lanes sum = A[packed_at(i, j)];
      if (i == j) sum += 1e-13 * trace;
      for (int k = 0; k < j; ++k) sum -= L[packed_at(i, k)] * L[packed_at(j, k)];
      if (i == j) smallest = sum < smallest ? sum : smallest;
      L[packed_at(i, j)] = i == j ? root(sum) : sum / L[packed_at(j, j)];
    }
  return smallest;
}

void project(Response& response, int lane) {
  Mat9 A;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) A(i, j) = response.tangent[packed_at(i, j)][lane];
  if (!A.triangularView<Eigen::Lower>().toDenseMatrix().allFinite()) return;
  const Eigen::SelfAdjointEigenSolver<Mat9> eigen(A);  // reads the lower triangle
  const Mat9& Q = eigen.eigenvectors();
  const Mat9 B = Q * eigen.eigenvalues().cwiseMax(0).asDiagonal() * Q.transpose();
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) response.tangent[packed_at(i, j)][lane] = B(i, j);
}

}  // namespace

void make_semidefinite(Response& response) {
  const Lanes pivot = smallest_pivot(response.tangent);
  for (int lane = 0; lane < lanes; ++lane)
    if (!(pivot[lane] > 0)) project(response, lane);
}

}  // namespace msml::fe
