// SPDX-License-Identifier: GPL-3.0-or-later
// Lanczos iterations and Schur's criterion.
#include "solver/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace msml::fe {
namespace {

constexpr int most_iterations = 120;

/// 1/sqrt(m) at free unknowns, 0 at fixed ones.
Vector inverse_roots(const ScalarMatrix& M, const Mask& fixed) {
  Vector roots = Vector::Zero(static_cast<Eigen::Index>(fixed.size()));
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const double m = M.values[static_cast<std::size_t>(M.pattern->diagonal[k / 3])];
    if (!fixed[k] && m > 0) roots[static_cast<Eigen::Index>(k)] = 1 / std::sqrt(m);
  }
  return roots;
}

/// A start without symmetry, the same in every run.
Vector start(const Vector& roots) {
  Vector q(roots.size());
  for (Eigen::Index k = 0; k < q.size(); ++k)
    q[k] = roots[k] > 0 ? std::sin(1.0 + 12.9898 * static_cast<double>(k % 100003)) : 0;
  const double size = std::sqrt(dot(q, q));
  return size > 0 ? Vector(q / size) : q;
}

}  // namespace

double largest_eigenvalue(const BlockMatrix& K, const ScalarMatrix& M, const Mask& fixed) {
  const Vector roots = inverse_roots(M, fixed);
  Vector before = Vector::Zero(roots.size()), q = start(roots), w;
  if (dot(q, q) == 0) return 0;
  std::vector<double> diagonal, off;
  double value = 0;
  for (int j = 0; j < most_iterations; ++j) {
    multiply(K, roots.cwiseProduct(q), w);
    w = roots.cwiseProduct(w);
    if (j > 0) w -= off.back() * before;
    diagonal.push_back(dot(q, w));
    w -= diagonal.back() * q;
    const double beta = std::sqrt(dot(w, w));
    const Eigen::Index n = static_cast<Eigen::Index>(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), n),
                                  Eigen::Map<Eigen::VectorXd>(off.data(), n - 1));
    value = solver.eigenvalues()[n - 1];
    // beta times the last component is the residual of the Ritz pair, which bounds the error of the value.
    const double bound = beta * std::abs(solver.eigenvectors()(n - 1, n - 1));
    if (!std::isfinite(value) || bound <= 1e-6 * value) break;
    off.push_back(beta);
    before = q;
    q = w / beta;
  }
  return value;
}

namespace {

/// Eigenvalues of the motion (x, x'); nothing where there are too many.
std::optional<Eigen::VectorXcd> motion_eigenvalues(const BlockMatrix& K, const BlockMatrix& C, const ScalarMatrix& M,
                                                   const Mask& fixed) {
  const LowerTriangle lower = lower_triangle(*K.pattern, fixed);
  const int n = lower.size();
  if (n > most_dense) return std::nullopt;
  std::vector<double> stiffness(lower.source.size()), damping(lower.source.size());
  lower.gather(K, stiffness.data());
  lower.gather(C, damping.data());
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);  // of (x, x')
  motion.topRightCorner(n, n).setIdentity();
  const auto mass = [&](int k) {
    return M.values[static_cast<std::size_t>(M.pattern->diagonal[static_cast<std::size_t>(lower.unknown_of[k] / 3)])];
  };
  for (int column = 0; column < n; ++column)
    for (int p = lower.starts[column]; p < lower.starts[column + 1]; ++p) {
      const int row = lower.rows[p];
      motion(n + row, column) = -stiffness[p] / mass(row);
      motion(n + column, row) = -stiffness[p] / mass(column);
      motion(n + row, n + column) = -damping[p] / mass(row);
      motion(n + column, n + row) = -damping[p] / mass(column);
    }
  if (n == 0) return Eigen::VectorXcd();
  return Eigen::VectorXcd(Eigen::EigenSolver<Eigen::MatrixXd>(motion, false).eigenvalues());
}

}  // namespace

std::optional<double> forward_euler_step(const BlockMatrix& K, const BlockMatrix& C, const ScalarMatrix& M,
                                         const Mask& fixed) {
  const auto values = motion_eigenvalues(K, C, M, fixed);
  if (!values) return std::nullopt;
  double limit = std::numeric_limits<double>::infinity();
  const double free = 1e-8 * (values->size() > 0 ? values->cwiseAbs().maxCoeff() : 0);
  for (const std::complex<double>& l : *values)
    if (std::abs(l) > free) limit = std::min(limit, std::max(0.0, -2 * l.real() / std::norm(l)));
  return limit;
}

std::optional<double> forward_euler_growth(const BlockMatrix& K, const BlockMatrix& C, const ScalarMatrix& M,
                                           const Mask& fixed, double dt) {
  const auto values = motion_eigenvalues(K, C, M, fixed);
  if (!values) return std::nullopt;
  double growth = 1;
  for (const std::complex<double>& l : *values) growth = std::max(growth, std::abs(1.0 + dt * l));
  return growth;
}

double stable_step(Integrator integrator, double largest, double alpha, double damping) {
  const double x = largest, c = alpha + damping;
  if (integrator == Integrator::central_difference) return 2 / (damping + std::sqrt(damping * damping + x));
  if (integrator == Integrator::symplectic_euler) return 4 / (c + std::sqrt(c * c + 4 * x));
  // x dt < c and 4 - 2 c dt + x dt^2 > 0 are linear in w^2: the ends of the spectrum decide.
  double limit = alpha > 0 ? 2 / alpha : std::numeric_limits<double>::infinity();
  if (x <= 0) return limit;
  limit = std::min(limit, c / x);
  if (c * c >= 4 * x) limit = std::min(limit, (c - std::sqrt(c * c - 4 * x)) / x);
  return limit;
}

}  // namespace msml::fe
