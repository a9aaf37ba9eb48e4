// SPDX-License-Identifier: GPL-3.0-or-later
// Facts about tetrahedral meshes, computed apart from the code under test.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::test {

/// Volume of the corners of cell c, positive where VTK's order is right-handed.
inline double tet_volume(const Mesh& mesh, int c) {
  const auto p = [&](int i) { return Vec3(mesh.points.row(mesh.cell(c)[i])); };
  return (p(1) - p(0)).cross(p(2) - p(0)).dot(p(3) - p(0)) / 6;
}

inline double total_volume(const Mesh& mesh) {
  double sum = 0;
  for (int c = 0; c < mesh.cell_count(); ++c) sum += tet_volume(mesh, c);
  return sum;
}

inline double smallest_volume(const Mesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int c = 0; c < mesh.cell_count(); ++c) smallest = std::min(smallest, tet_volume(mesh, c));
  return smallest;
}

inline std::map<int, double> region_volumes(const Mesh& mesh) {
  std::map<int, double> volumes;
  for (int c = 0; c < mesh.cell_count(); ++c) volumes[mesh.region(c)] += tet_volume(mesh, c);
  return volumes;
}

/// How many tetrahedra each corner set of `size` points out of four belongs to.
inline std::map<std::vector<int>, int> simplices(const Mesh& mesh, int size) {
  std::map<std::vector<int>, int> found;
  for (int c = 0; c < mesh.cell_count(); ++c)
    for (int mask = 0; mask < 16; ++mask) {
      std::vector<int> key;
      for (int i = 0; i < 4; ++i)
        if (mask >> i & 1) key.push_back(mesh.cell(c)[i]);
      if (static_cast<int>(key.size()) != size) continue;
      std::sort(key.begin(), key.end());
      ++found[key];
    }
  return found;
}

/// Points - edges + faces - tetrahedra: 1 for a ball, 0 for a tube or a ring, 2 for a ball with a cavity.
inline long euler_characteristic(const Mesh& mesh) {
  return static_cast<long>(simplices(mesh, 1).size()) - static_cast<long>(simplices(mesh, 2).size()) +
         static_cast<long>(simplices(mesh, 3).size()) - mesh.cell_count();
}

/// Faces that one tetrahedron alone has.
inline long boundary_faces(const Mesh& mesh) {
  const auto faces = simplices(mesh, 3);
  return std::count_if(faces.begin(), faces.end(), [](const auto& face) { return face.second == 1; });
}

/// Equal to the last bit.
inline bool same(const Mesh& a, const Mesh& b) {
  return a.points == b.points && a.kinds == b.kinds && a.nodes == b.nodes && a.regions == b.regions;
}

}  // namespace msml::test
