// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrature rules, computed from orthogonal polynomials rather than typed in.
#include "solver/elements/quadrature.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace msml::fe {
namespace {

/// Gauss rule for the weight (1 - x)^a on [0, 1]: the eigenvalues of the three-term recurrence of the Jacobi
/// polynomials P^(a,0) on [-1, 1], mapped (Golub and Welsch 1969, doi 10.1090/S0025-5718-69-99647-1).
std::vector<QuadraturePoint<1>> gauss_jacobi(int n, int a) {
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    const double s = 2.0 * k + a;
    recurrence(k, k) = k == 0 ? -a / (a + 2.0) : -1.0 * a * a / (s * (s + 2));
    if (k == 0) continue;
    const double square = 4.0 * k * (k + a) * k * (k + a) / (s * s * (s * s - 1));
    recurrence(k, k - 1) = recurrence(k - 1, k) = std::sqrt(square);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(recurrence);
  std::vector<QuadraturePoint<1>> rule;
  for (int k = 0; k < n; ++k) {
    const double first = solver.eigenvectors()(0, k);
    rule.push_back({{(1 + solver.eigenvalues()(k)) / 2}, first * first / (a + 1)});
  }
  return rule;
}

}  // namespace

Rule<3> one_point_rule() { return {{{0.25, 0.25, 0.25}, 1.0 / 6}}; }

Rule<3> four_point_rule() {
  const double a = (5 + 3 * std::sqrt(5.0)) / 20, b = (5 - std::sqrt(5.0)) / 20, w = 1.0 / 24;
  return {{{b, b, b}, w}, {{a, b, b}, w}, {{b, a, b}, w}, {{b, b, a}, w}};
}

Rule<3> collapsed_tetrahedron_rule(int n) {
  Rule<3> rule;
  for (const auto& x : gauss_jacobi(n, 2))
    for (const auto& y : gauss_jacobi(n, 1))
      for (const auto& z : gauss_jacobi(n, 0)) {
        const double p = x.xi[0], q = y.xi[0] * (1 - p), r = z.xi[0] * (1 - p) * (1 - y.xi[0]);
        rule.push_back({{p, q, r}, x.weight * y.weight * z.weight});
      }
  return rule;
}

Rule<2> collapsed_triangle_rule(int n) {
  Rule<2> rule;
  for (const auto& x : gauss_jacobi(n, 1))
    for (const auto& y : gauss_jacobi(n, 0)) rule.push_back({{x.xi[0], y.xi[0] * (1 - x.xi[0])}, x.weight * y.weight});
  return rule;
}

Rule<2> triangle_rule(int points) {
  if (points == 1) return {{{1.0 / 3, 1.0 / 3}, 0.5}};
  const double a = 2.0 / 3, b = 1.0 / 6;
  return {{{b, b}, b}, {{a, b}, b}, {{b, a}, b}};
}

Rule<1> line_rule(int n) { return gauss_jacobi(n, 0); }

}  // namespace msml::fe
