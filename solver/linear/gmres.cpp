// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible GMRES with restarts.
#include "solver/linear/gmres.hpp"

#include <Eigen/QR>
#include <cmath>

namespace msml::fe {
namespace {

constexpr int restart = 80, most_restarts = 5;

void mask(const Mask& fixed, Vector& v) {
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (fixed[k]) v[static_cast<Eigen::Index>(k)] = 0;
}

/// One cycle: adds to x the best combination of preconditioned directions for the residual r.
LinearStatus cycle(const LinearMap& A, LinearSystem& nearby, const Mask& fixed, const Vector& r, double target,
                   Vector& x) {
  const double size = std::sqrt(dot(r, r));
  std::vector<Vector> basis{r / size}, directions;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(restart + 1, restart);
  Eigen::VectorXd y;
  for (int j = 0; j < restart; ++j) {
    Vector z, w;
    const LinearStatus status = nearby.solve(basis.back(), 1e-6, z);
    if (status != LinearStatus::done) return status;
    A(z, w);
    mask(fixed, w);
    directions.push_back(std::move(z));
    for (int pass = 0; pass < 2; ++pass)  // once more: Gram-Schmidt alone loses orthogonality
      for (int i = 0; i <= j; ++i) {
        const double h = dot(w, basis[static_cast<std::size_t>(i)]);
        H(i, j) += h;
        w -= h * basis[static_cast<std::size_t>(i)];
      }
    H(j + 1, j) = std::sqrt(dot(w, w));
    if (!std::isfinite(H(j + 1, j))) return LinearStatus::singular;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(j + 2);
    right[0] = size;
    const Eigen::MatrixXd square = H.topLeftCorner(j + 2, j + 1);
    y = square.colPivHouseholderQr().solve(right);
    const bool good = (right - square * y).norm() <= 0.5 * target;
    if (good || H(j + 1, j) <= 1e-14 * size || j + 1 == restart) break;
    basis.push_back(w / H(j + 1, j));
  }
  for (Eigen::Index j = 0; j < y.size(); ++j) x += y[j] * directions[static_cast<std::size_t>(j)];
  return LinearStatus::done;
}

}  // namespace

LinearStatus solve_unsymmetric(const LinearMap& A, LinearSystem& nearby, const Mask& fixed, const Vector& b,
                               double tolerance, Vector& x) {
  Vector r = b, product;
  mask(fixed, r);
  const Vector right = r;
  x = Vector::Zero(b.size());
  const double whole = std::sqrt(dot(right, right)), target = tolerance * whole;
  double before = whole;
  for (int round = 0; round <= most_restarts; ++round) {
    const double size = std::sqrt(dot(r, r));
    if (size <= target) return LinearStatus::done;
    // Round-off in A x can exceed the target where x is large; more cycles do not help then.
    const bool stalled = round > 0 && size > 0.5 * before;
    if (stalled || round == most_restarts) return size <= 1e-4 * whole ? LinearStatus::done : LinearStatus::limit;
    before = size;
    const LinearStatus status = cycle(A, nearby, fixed, r, target, x);
    if (status != LinearStatus::done) return status;
    A(x, product);
    r = right - product;
    mask(fixed, r);
  }
  return LinearStatus::limit;
}

}  // namespace msml::fe
