// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrature on the sides of elements: faces, edges and ends.
#pragma once
#include <Eigen/Geometry>

#include "solver/conditions/loads.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::fe {

/// A quadrature point of a side: shape values, their derivatives, and two tangents r and s with outward normal r x s.
/// The second tangent of an edge, and both of an end point, are those of a plate of the model's thickness (a bar of its
/// cross-section), which do not change.
template <int nodes>
struct SidePoint {
  std::array<double, nodes> N{};
  std::array<std::array<double, 2>, nodes> dN{};
  double weight = 1;
  Vec3 r = Vec3::Zero(), s = Vec3::Zero();
};

/// Calls body(point) at each point of a face; `x(a)` is the position of the side's node a. The rules are exact for a
/// quadratic side, degree 2 (N) + 2 (normal); for loads that vary over the side they are four degrees better.
template <int nodes, class Position, class Body>
void for_face_points(const Position& x, bool varying, const Body& body) {
  static const Rule<2> rules[2] = {collapsed_triangle_rule(nodes == 3 ? 1 : 3),
                                   collapsed_triangle_rule(nodes == 3 ? 3 : 5)};
  for (const auto& q : rules[varying]) {
    SidePoint<nodes> point{Triangle<nodes>::values(q.xi), Triangle<nodes>::gradients(q.xi), q.weight};
    for (int a = 0; a < nodes; ++a) {
      point.r += point.dN[a][0] * x(a);
      point.s += point.dN[a][1] * x(a);
    }
    body(point);
  }
}

/// Gauss's rule along an edge of `nodes` nodes, from 0 to 1.
inline const Rule<1>& edge_rule(int nodes, bool varying) {
  static const Rule<1> linear[2] = {line_rule(1), line_rule(3)}, quadratic[2] = {line_rule(2), line_rule(4)};
  return nodes == 2 ? linear[varying] : quadratic[varying];
}

/// The same for an edge of a triangle; counter-clockwise edges have r x e_z outside.
template <int nodes, class Position, class Body>
void for_edge_points(const Position& x, double thickness, bool varying, const Body& body) {
  for (const auto& q : edge_rule(nodes, varying)) {
    SidePoint<nodes> point{.N = Simplex<1, nodes>::values(q.xi), .weight = q.weight};
    const auto gradients = Simplex<1, nodes>::gradients(q.xi);
    for (int a = 0; a < nodes; ++a) {
      point.dN[a] = {gradients[a][0], 0};
      point.r += point.dN[a][0] * x(a);
    }
    point.s = thickness * Vec3::UnitZ();
    body(point);
  }
}

/// Calls body(point), a generic function, at each quadrature point of a side.
template <class Position, class Body>
void for_side_points(const FollowerFace& face, const Position& x, bool varying, const Body& body) {
  if (face.kind == CellKind::tri3) return for_face_points<3>(x, varying, body);
  if (face.kind == CellKind::tri6) return for_face_points<6>(x, varying, body);
  if (face.kind == CellKind::line2) return for_edge_points<2>(x, face.thickness, varying, body);
  if (face.kind == CellKind::line3) return for_edge_points<3>(x, face.thickness, varying, body);
  SidePoint<1> point{.N = {1}, .r = (face.end == 0 ? -1.0 : 1.0) * Vec3::UnitY(), .s = face.thickness * Vec3::UnitZ()};
  body(point);
}

/// The sum of N_a x(a) over the nodes of a point.
template <int nodes, class Position>
Vec3 interpolate(const SidePoint<nodes>& point, const Position& x) {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < nodes; ++a) sum += point.N[static_cast<std::size_t>(a)] * x(a);
  return sum;
}

}  // namespace msml::fe
