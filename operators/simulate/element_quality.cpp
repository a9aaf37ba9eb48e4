// SPDX-License-Identifier: GPL-3.0-or-later
// Angles and radius ratios of tetrahedra and triangles.
#include "operators/simulate/element_quality.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace msml::simulation {
namespace {

/// Inner angle in degrees between the two faces that meet in edge ab, with c and d across.
double dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 edge = b - a;
  const Vec3 m = edge.cross(c - a), n = edge.cross(d - a);
  return std::atan2(m.cross(n).norm(), m.dot(n)) * 180 / EIGEN_PI;
}

}  // namespace

Shape tetrahedron_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Shape shape;
  shape.smallest_angle = std::min({dihedral(a, b, c, d), dihedral(a, c, b, d), dihedral(a, d, b, c),
                                   dihedral(b, c, a, d), dihedral(b, d, a, c), dihedral(c, d, a, b)});
  const double volume = std::abs((b - a).cross(c - a).dot(d - a)) / 6;
  const double area = ((b - a).cross(c - a).norm() + (b - a).cross(d - a).norm() + (c - a).cross(d - a).norm() +
                       (c - b).cross(d - b).norm()) /
                      2;
  const double p = (b - a).norm() * (d - c).norm(), q = (c - a).norm() * (d - b).norm(),
               r = (d - a).norm() * (c - b).norm();
  const double product = std::max(0.0, (p + q + r) * (p + q - r) * (p - q + r) * (q + r - p));
  // 3 r_in / R_out = (9 V / A) (24 V / sqrt(product))
  if (area > 0 && product > 0) shape.radius_ratio = 216 * volume * volume / (area * std::sqrt(product));
  return shape;
}

Shape triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto angle = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return std::atan2((q - p).cross(r - p).norm(), (q - p).dot(r - p)) * 180 / EIGEN_PI;
  };
  Shape shape;
  shape.smallest_angle = std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
  const double p = (b - a).norm(), q = (c - b).norm(), r = (a - c).norm();
  const double area = (b - a).cross(c - a).norm() / 2;
  // 2 r_in / R_out = 2 (2 A / (p + q + r)) (4 A / (p q r))
  if (p * q * r > 0) shape.radius_ratio = 16 * area * area / ((p + q + r) * p * q * r);
  return shape;
}

WorstShape worst_shape(const Body& body) {
  WorstShape worst;
  if (dimension(body.kind) < 2) return worst;
  for (const int id : body.elements) {
    const int* nodes = body.mesh->cell(id);
    const auto corner = [&](int i) -> Vec3 { return body.mesh->points.row(nodes[i]).transpose(); };
    const Shape shape = dimension(body.kind) == 3 ? tetrahedron_shape(corner(0), corner(1), corner(2), corner(3))
                                                  : triangle_shape(corner(0), corner(1), corner(2));
    if (shape.smallest_angle < worst.smallest_angle) {
      worst.smallest_angle = shape.smallest_angle;
      worst.angle_element = id;
    }
    if (worst.ratio_element < 0 || shape.radius_ratio < worst.radius_ratio) {
      worst.radius_ratio = shape.radius_ratio;
      worst.ratio_element = id;
    }
  }
  return worst;
}

}  // namespace msml::simulation
