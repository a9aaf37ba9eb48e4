// SPDX-License-Identifier: GPL-3.0-or-later
// Points and weights on the reference tetrahedron (volume 1/6), triangle (area 1/2) and line (0 to 1).
#pragma once
#include <array>
#include <vector>

namespace msml::fe {

/// One point of a rule: reference coordinates and weight.
template <int dimension>
struct QuadraturePoint {
  std::array<double, dimension> xi;
  double weight;
};

template <int dimension>
using Rule = std::vector<QuadraturePoint<dimension>>;

/// The centroid rule, exact to degree 1.
Rule<3> one_point_rule();

/// Four points with one barycentric coordinate (5 + 3 sqrt 5)/20, exact to degree 2 (Hammer, Marlowe and Stroud 1956,
/// doi 10.1090/S0025-5718-1956-0086389-6).
Rule<3> four_point_rule();

/// n^3 points, exact to degree 2n - 1, all weights positive: Gauss-Jacobi rules on the collapsed cube (Stroud 1971,
/// Approximate Calculation of Multiple Integrals, chapter 2). n >= 1.
Rule<3> collapsed_tetrahedron_rule(int n);

/// n^2 points on the triangle, exact to degree 2n - 1.
Rule<2> collapsed_triangle_rule(int n);

/// The centroid of the triangle, exact to degree 1; and the three points with barycentric coordinates 2/3, 1/6, 1/6,
/// exact to degree 2 (Hammer, Marlowe and Stroud 1956).
Rule<2> triangle_rule(int points);

/// n points on the line, exact to degree 2n - 1 (Gauss).
Rule<1> line_rule(int n);

/// The rule with n^dimension points that is exact to degree 2n - 1: line_rule, collapsed_triangle_rule,
/// collapsed_tetrahedron_rule.
template <int dimension>
Rule<dimension> rule_of_size(int n) {
  if constexpr (dimension == 1) return line_rule(n);
  if constexpr (dimension == 2) return collapsed_triangle_rule(n);
  if constexpr (dimension == 3) return collapsed_tetrahedron_rule(n);
}

}  // namespace msml::fe
