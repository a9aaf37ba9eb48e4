// SPDX-License-Identifier: GPL-3.0-or-later
// Bars with moved nodes and with slivers, drawn at random.
#pragma once
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "tests/solver/meshes.hpp"
#include "tests/stability/draw.hpp"

namespace msml::fe::testing {

/// The same tetrahedra with a node amid each edge.
inline Mesh with_mid_nodes(const Mesh& linear) {
  std::map<std::array<int, 2>, int> known;
  std::vector<Vec3> points;
  for (int k = 0; k < linear.point_count(); ++k) points.push_back(linear.points.row(k).transpose());
  Mesh mesh;
  for (int e = 0; e < linear.cell_count(); ++e) {
    std::array<int, 10> nodes;
    for (int a = 0; a < 4; ++a) nodes[static_cast<std::size_t>(a)] = linear.cell(e)[a];
    for (int k = 0; k < 6; ++k) {
      const auto [a, b] = edge_of(k);
      const int i = linear.cell(e)[a], j = linear.cell(e)[b];
      const auto [it, fresh] = known.emplace(std::array<int, 2>{std::min(i, j), std::max(i, j)}, points.size());
      if (fresh) points.push_back((linear.points.row(i) + linear.points.row(j)).transpose() / 2);
      nodes[static_cast<std::size_t>(4 + k)] = it->second;
    }
    mesh.add_cell(CellKind::tet10, nodes.data());
  }
  mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) mesh.points.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  return mesh;
}

/// Six times the smallest volume of an element around a node, or of all for -1.
inline double smallest_volume(const Mesh& mesh, int node) {
  double smallest = 1e300;
  for (int e = 0; e < mesh.cell_count(); ++e) {
    const int* c = mesh.cell(e);
    if (node >= 0 && std::find(c, c + 4, node) == c + 4) continue;
    const auto edge = [&](int a) -> Vec3 { return (mesh.points.row(c[a]) - mesh.points.row(c[0])).transpose(); };
    smallest = std::min(smallest, edge(1).cross(edge(2)).dot(edge(3)));
  }
  return smallest;
}

/// Presses a node towards the middle of the face opposite in one of its elements, until that element has `height` of
/// the height it had. False, and nothing done, if another element would turn inside out.
inline bool press_node(Mesh& mesh, int element, int corner, double height) {
  const int* c = mesh.cell(element);
  const Vec3 before = mesh.points.row(c[corner]).transpose();
  Vec3 foot = Vec3::Zero();
  for (int a = 0; a < 4; ++a)
    if (a != corner) foot += mesh.points.row(c[a]).transpose() / 3;
  mesh.points.row(c[corner]) = (foot + height * (before - foot)).transpose();
  if (smallest_volume(mesh, c[corner]) > 0) return true;
  mesh.points.row(c[corner]) = before.transpose();
  return false;
}

/// A sliver: a node between the ends pressed to a height of `low` to `high`.
inline void draw_sliver(Draw& draw, Mesh& mesh, std::string& words, double low = 1e-6, double high = 0.3) {
  const double height = draw.power(low, high);
  for (int trial = 0; trial < 100; ++trial) {
    const int element = draw.index(mesh.cell_count()), corner = draw.index(4);
    const Vec3 x = mesh.points.row(mesh.cell(element)[corner]).transpose();
    if (at_wall(x) || at_end(x) || !press_node(mesh, element, corner, height)) continue;
    words += fmt::format("sliver {:.1e}, ", height);
    return;
  }
}

/// A bar of 2 x 1 x 1 whose inner nodes are moved by up to 0.3 of the mesh size, some of them with a sliver.
inline Mesh draw_mesh(Draw& draw, CellKind kind, std::string& words) {
  const int n = 1 + draw.index(2);
  const double rough = draw.chance(0.5) ? 0 : draw.number(0.05, 0.3);
  words += fmt::format("{} n = {} rough {:.2f}, ", name(kind), n, rough);
  Mesh mesh = box_mesh(2 * n, n, n, {drawn_length, 1, 1}, CellKind::tet4);
  for (int k = 0; k < mesh.point_count(); ++k) {
    const Vec3 x = mesh.points.row(k).transpose();
    for (int i = 0; i < 3; ++i)
      if (x[i] > 1e-9 && x[i] < (i == 0 ? drawn_length : 1) - 1e-9) mesh.points(k, i) += draw.number(-1, 1) * rough / n;
  }
  if (draw.chance(0.2)) draw_sliver(draw, mesh, words);
  return kind == CellKind::tet4 ? mesh : with_mid_nodes(mesh);
}

}  // namespace msml::fe::testing
