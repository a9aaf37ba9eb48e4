// SPDX-License-Identifier: GPL-3.0-or-later
// Faces and Jacobians of tetrahedra.
#include "operators/mesh_tets.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

using Nodes = Eigen::Matrix<double, 10, 3>;
using Gradient = Mat3;  ///< dx/dxi, one column per xi

/// Gradients of the quadratic shape functions, from N_i = l_i (2 l_i - 1) at corners and 4 l_i l_j on edges.
Gradient gradient(const Nodes& nodes, const Vec3& xi) {
  constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const std::array<double, 4> l{1 - xi.sum(), xi.x(), xi.y(), xi.z()};
  const std::array<Vec3, 4> dl{-Vec3::Ones(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  Gradient g = Gradient::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    g += nodes.row(static_cast<int>(i)).transpose() * ((4 * l[i] - 1) * dl[i]).transpose();
  for (std::size_t e = 0; e < 6; ++e) {
    const auto a = static_cast<std::size_t>(edges[e][0]), b = static_cast<std::size_t>(edges[e][1]);
    g += nodes.row(4 + static_cast<int>(e)).transpose() * (4 * (l[a] * dl[b] + l[b] * dl[a])).transpose();
  }
  return g;
}

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); }

/// dx/dxi is linear in xi, so its values at the corners are its Bernstein coefficients. The determinant of the columns
/// is trilinear in them; its coefficient at the multiset {p, q, r} of corners is the mean over all orders of which
/// corner each column is taken from. Returns the 20 coefficients.
std::array<double, 20> bernstein(const Nodes& nodes) {
  const std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  std::array<Gradient, 4> g;
  for (std::size_t i = 0; i < 4; ++i) g[i] = gradient(nodes, corners[i]);
  std::array<double, 20> coefficients;
  std::size_t n = 0;
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t q = p; q < 4; ++q)
      for (std::size_t r = q; r < 4; ++r) {
        std::array<std::size_t, 3> order{0, 1, 2};
        const std::array<std::size_t, 3> from{p, q, r};
        double sum = 0;
        do sum += determinant(g[from[order[0]]].col(0), g[from[order[1]]].col(1), g[from[order[2]]].col(2));
        while (std::next_permutation(order.begin(), order.end()));
        coefficients[n++] = sum / 6;
      }
  return coefficients;
}

struct FaceKey {
  std::array<int, 3> corners;  ///< ascending
  OuterFace face;
};

/// Calls use(key) for every face of every tetrahedron.
template <class Use>
void for_faces(const Mesh& mesh, const Use& use) {
  for (int c = 0; c < mesh.cell_count(); ++c) {
    if (!is_tet(mesh.kinds[static_cast<std::size_t>(c)])) continue;
    const int* nodes = mesh.cell(c);
    for (int f = 0; f < 4; ++f) {
      const auto& local = tet_faces[static_cast<std::size_t>(f)];
      int a = nodes[local[0]], b = nodes[local[1]], d = nodes[local[2]];
      if (a > b) std::swap(a, b);
      if (b > d) std::swap(b, d);
      if (a > b) std::swap(a, b);
      use(FaceKey{{a, b, d}, {c, f}});
    }
  }
}

/// By corners, then by cell: first into a bucket for each smallest corner, then in the bucket.
std::vector<FaceKey> sorted_faces(const Mesh& mesh) {
  int most = -1;
  for_faces(mesh, [&](const FaceKey& key) { most = std::max(most, key.corners[0]); });
  std::vector<std::size_t> ends(static_cast<std::size_t>(most + 2), 0);
  for_faces(mesh, [&](const FaceKey& key) { ++ends[static_cast<std::size_t>(key.corners[0]) + 1]; });
  for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
  std::vector<FaceKey> faces(ends.back());
  for_faces(mesh, [&](const FaceKey& key) { faces[ends[static_cast<std::size_t>(key.corners[0])]++] = key; });
  const auto before = [](const FaceKey& a, const FaceKey& b) {
    return std::tie(a.corners, a.face.cell) < std::tie(b.corners, b.face.cell);
  };
  for (std::size_t i = 0, begin = 0; i + 1 < ends.size(); begin = ends[i++])
    std::sort(faces.begin() + static_cast<long>(begin), faces.begin() + static_cast<long>(ends[i]), before);
  return faces;
}

}  // namespace

bool is_tet(CellKind kind) { return kind == CellKind::tet4 || kind == CellKind::tet10; }

void require_tets(const Mesh& mesh, const char* operation) {
  if (mesh.count(CellKind::tet4) + mesh.count(CellKind::tet10) == 0)
    throw Error(fmt::format("{} needs tetrahedra, but the mesh has {}", operation, mesh.summary()));
}

Eigen::Matrix<double, 4, 3> corners_of(const Mesh& mesh, int cell) {
  Eigen::Matrix<double, 4, 3> corners;
  for (int i = 0; i < 4; ++i) corners.row(i) = mesh.points.row(mesh.cell(cell)[i]);
  return corners;
}

Nodes nodes_of(const Mesh& mesh, int cell) {
  Nodes nodes;
  for (int i = 0; i < 10; ++i) nodes.row(i) = mesh.points.row(mesh.cell(cell)[i]);
  return nodes;
}

double volume(const Eigen::Matrix<double, 4, 3>& p) {
  return determinant(p.row(1) - p.row(0), p.row(2) - p.row(0), p.row(3) - p.row(0)) / 6;
}

std::vector<OuterFace> outer_faces(const Mesh& mesh) {
  const std::vector<FaceKey> faces = sorted_faces(mesh);
  std::vector<OuterFace> outer;
  for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
    while (j < faces.size() && faces[j].corners == faces[i].corners) ++j;
    if (j - i == 1) outer.push_back(faces[i].face);
    if (j - i > 2)
      throw Error(fmt::format("face {} {} {} is shared by {} tetrahedra, cells {}, {} and {} among them",
                              faces[i].corners[0], faces[i].corners[1], faces[i].corners[2], j - i, faces[i].face.cell,
                              faces[i + 1].face.cell, faces[i + 2].face.cell));
  }
  std::sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) {
    return std::tie(a.cell, a.local) < std::tie(b.cell, b.local);
  });
  return outer;
}

double jacobian(const Nodes& nodes, const Vec3& xi) { return gradient(nodes, xi).determinant(); }

double jacobian_bound(const Nodes& nodes) {
  const auto coefficients = bernstein(nodes);
  return *std::min_element(coefficients.begin(), coefficients.end());
}

double curved_volume(const Nodes& nodes) {
  // Every Bernstein polynomial of a degree has the same integral: volume of the simplex over their number.
  double sum = 0;
  for (const double coefficient : bernstein(nodes)) sum += coefficient;
  return sum / 20 / 6;
}

}  // namespace msml::operators
