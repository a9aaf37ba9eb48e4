// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions of lines, triangles and tetrahedra in VTK's node order.
#pragma once
#include <Eigen/LU>
#include <array>

#include "msml/core/mesh.hpp"
#include "solver/elements/quadrature.hpp"

namespace msml::fe {

/// A simplex of `dimension` with `nodes` nodes: 4 or 10 (tetrahedron), 3 or 6 (triangle), 2 or 3 (line), 1 (point).
/// Reference corners: the origin, then the unit points of each axis. Mid nodes:
///   tetrahedron 4 on 01, 5 on 12, 6 on 20, 7 on 03, 8 on 13, 9 on 23;   triangle 3 on 01, 4 on 12, 5 on 20;
///   line 2 on 01.
template <int dimension, int nodes>
struct Simplex {
  static constexpr int corners = dimension + 1;
  static constexpr bool quadratic = nodes > corners;
  using Point = std::array<double, dimension>;

  /// The two corners of the edge that carries mid node `corners + k`.
  static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

  /// Barycentric coordinates of a reference point.
  static std::array<double, corners> barycentric(const Point& xi) {
    std::array<double, corners> L;
    L[0] = 1;
    for (int d = 0; d < dimension; ++d) {
      L[0] -= xi[d];
      L[d + 1] = xi[d];
    }
    return L;
  }

  /// Values N_a(xi): L_a (linear); L_a (2 L_a - 1) at corners and 4 L_i L_j at mid nodes (quadratic).
  static std::array<double, nodes> values(const Point& xi) {
    const auto L = barycentric(xi);
    std::array<double, nodes> N;
    for (int a = 0; a < corners; ++a) N[a] = quadratic ? L[a] * (2 * L[a] - 1) : L[a];
    for (int a = corners; a < nodes; ++a) N[a] = 4 * L[edges[a - corners][0]] * L[edges[a - corners][1]];
    return N;
  }

  /// Derivatives dN_a/dxi_d, #nodes x dimension.
  static std::array<Point, nodes> gradients(const Point& xi) {
    const auto L = barycentric(xi);
    const auto dL = [](int corner, int d) { return corner == 0 ? -1.0 : (corner == d + 1 ? 1.0 : 0.0); };
    std::array<Point, nodes> g;
    for (int d = 0; d < dimension; ++d) {
      for (int a = 0; a < corners; ++a) g[a][d] = (quadratic ? 4 * L[a] - 1 : 1.0) * dL(a, d);
      for (int a = corners; a < nodes; ++a) {
        const auto [i, j] = edges[a - corners];
        g[a][d] = 4 * (L[i] * dL(j, d) + L[j] * dL(i, d));
      }
    }
    return g;
  }
};

template <int nodes>
using Tetrahedron = Simplex<3, nodes>;
template <int nodes>
using Triangle = Simplex<2, nodes>;

/// The rule for internal forces and stiffness, exact for the stiffness of straight elements: 1 point (line2, tri3,
/// tet4), 2 (line3), 3 (tri6), 4 (tet10).
template <int dimension, int nodes>
constexpr int stiffness_points = Simplex<dimension, nodes>::quadratic ? dimension + 1 : 1;
template <int dimension, int nodes>
Rule<dimension> stiffness_rule() {
  constexpr int count = stiffness_points<dimension, nodes>;
  if constexpr (dimension == 1) return line_rule(count);
  if constexpr (dimension == 2) return triangle_rule(count);
  if constexpr (dimension == 3) return count == 1 ? one_point_rule() : four_point_rule();
}

template <int dimension>
using Jacobian = Eigen::Matrix<double, dimension, dimension>;

/// dX/dxi of an element at a reference point: J(i, d) = sum_a X_a,i dN_a/dxi_d. `ids` are rows of `points`; triangles
/// use x and y, lines x.
template <int dimension, int nodes>
Jacobian<dimension> jacobian(const Points& points, const int* ids, const std::array<double, dimension>& xi) {
  const auto g = Simplex<dimension, nodes>::gradients(xi);
  Jacobian<dimension> J = Jacobian<dimension>::Zero();
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < dimension; ++i)
      for (int d = 0; d < dimension; ++d)
        J(i, d) += points(ids[a], i) * g[static_cast<std::size_t>(a)][static_cast<std::size_t>(d)];
  return J;
}

/// True if the Jacobian is the same everywhere, to round-off: mid nodes halve straight edges.
template <int dimension, int nodes>
bool straight(const Points& points, const int* ids) {
  using Shape = Simplex<dimension, nodes>;
  for (int a = Shape::corners; a < nodes; ++a) {
    const auto [i, j] = Shape::edges[static_cast<std::size_t>(a - Shape::corners)];
    const auto first = points.row(ids[i]), second = points.row(ids[j]);
    if ((2 * points.row(ids[a]) - first - second).cwiseAbs().maxCoeff() >
        1e-14 * (first.cwiseAbs().maxCoeff() + second.cwiseAbs().maxCoeff()))
      return false;
  }
  return true;
}

/// The reference position of a point of an element.
template <int dimension, int nodes>
Vec3 place(const Points& points, const int* ids, const std::array<double, dimension>& xi) {
  const auto N = Simplex<dimension, nodes>::values(xi);
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < nodes; ++a) x += N[static_cast<std::size_t>(a)] * points.row(ids[a]).transpose();
  return x;
}

}  // namespace msml::fe
