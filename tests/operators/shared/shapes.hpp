// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes with known volumes, and the volume of a surface.
#pragma once
#include <Eigen/Geometry>

#include "msml/core/image.hpp"
#include "msml/core/mesh.hpp"

namespace msml::test {

/// Enclosed volume by the divergence theorem: sum of a . (b x c) / 6, positive where triangles face outwards.
inline double volume(const Surface& s) {
  double sum = 0;
  for (const auto& t : s.triangles) {
    const Vec3 a = s.points.row(t[0]), b = s.points.row(t[1]), c = s.points.row(t[2]);
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

/// An axis-parallel box of twelve triangles that face outwards.
inline Surface box(const Vec3& low, const Vec3& high) {
  Surface s;
  s.points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    s.points.row(i) << (i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2];
  s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return s;
}

/// A cube of five tetrahedra on the corners of [0, 1]^3.
inline Mesh five_tets() {
  Mesh m;
  m.points = box(Vec3::Zero(), Vec3::Ones()).points;
  const int tets[5][4] = {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};
  for (const auto& t : tets) m.add_cell(CellKind::tet4, t);
  return m;
}

}  // namespace msml::test
