// SPDX-License-Identifier: GPL-3.0-or-later
// Peeling of flat tetrahedra off the boundary.
#include "operators/mesh_flat.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

bool flat(const Mesh& mesh, int cell) {
  const auto p = corners_of(mesh, cell);
  double longest2 = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) longest2 = std::max(longest2, (p.row(i) - p.row(j)).squaredNorm());
  return std::abs(volume(p)) < 1e-4 * longest2 * std::sqrt(longest2);
}

using Edge = std::pair<int, int>;
Edge edge(int a, int b) { return std::minmax(a, b); }

/// What the boundary holds: its edges, and for each cell in it the local numbers of its outer faces.
struct Boundary {
  std::set<Edge> edges;
  std::map<int, std::vector<int>> faces;
};

/// The cells of a mesh that have one of the marked points, with its point ids; `ids` receives their ids.
Mesh around(const Mesh& mesh, const std::vector<char>& marked, std::vector<int>& ids) {
  Mesh near;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const int* nodes = mesh.cell(c);
    if (!std::any_of(nodes, nodes + 4, [&](int node) { return marked[static_cast<std::size_t>(node)]; })) continue;
    near.add_cell(CellKind::tet4, nodes);
    ids.push_back(c);
  }
  return near;
}

/// The boundary as far as flat cells see it: all that have a face with a point of theirs are looked at, and no others.
Boundary boundary_at(const Mesh& mesh, const std::vector<int>& flat_cells) {
  std::vector<char> marked(static_cast<std::size_t>(mesh.point_count()), 0);
  for (const int cell : flat_cells)
    for (int i = 0; i < 4; ++i) marked[static_cast<std::size_t>(mesh.cell(cell)[i])] = 1;
  std::vector<int> ids;
  const Mesh near = around(mesh, marked, ids);
  Boundary boundary;
  for (const auto& [cell, local] : outer_faces(near)) {
    // A face without a marked point may have a neighbour that was left out.
    const auto& f = tet_faces[static_cast<std::size_t>(local)];
    const auto corner = [&f, nodes = near.cell(cell)](std::size_t i) { return nodes[f[i % 3]]; };
    const auto seen = [&](std::size_t i) { return marked[static_cast<std::size_t>(corner(i))] != 0; };
    if (!seen(0) && !seen(1) && !seen(2)) continue;
    boundary.faces[ids[static_cast<std::size_t>(cell)]].push_back(local);
    for (std::size_t i = 0; i < 3; ++i) boundary.edges.insert(edge(corner(i), corner(i + 1)));
  }
  return boundary;
}

/// A cell with three outer faces leaves its fourth; one with two leaves an edge that the boundary must not have yet.
bool removable(const Mesh& mesh, const Boundary& boundary, int cell, const std::vector<int>& outer) {
  if (outer.size() == 3) return true;
  const int* nodes = mesh.cell(cell);  // face i lies opposite corner i
  return outer.size() == 2 && !boundary.edges.count(edge(nodes[outer[0]], nodes[outer[1]]));
}

std::vector<int> flat_cells(const Mesh& mesh) {
  std::vector<int> cells;
  for (int c = 0; c < mesh.cell_count(); ++c)
    if (flat(mesh, c)) cells.push_back(c);
  return cells;
}

/// Flat cells that can go together: none shares a point with another.
std::set<int> removable_cells(const Mesh& mesh) {
  const std::vector<int> flats = flat_cells(mesh);
  std::set<int> cells, touched;
  if (flats.empty()) return cells;
  const Boundary boundary = boundary_at(mesh, flats);
  for (const int cell : flats) {
    const int* nodes = mesh.cell(cell);
    const auto outer = boundary.faces.find(cell);
    if (outer == boundary.faces.end() || !removable(mesh, boundary, cell, outer->second)) continue;
    if (std::any_of(nodes, nodes + 4, [&](int node) { return touched.count(node) > 0; })) continue;
    touched.insert(nodes, nodes + 4);
    cells.insert(cell);
  }
  return cells;
}

Mesh without(const Mesh& mesh, const std::set<int>& cells) {
  Mesh out;
  std::vector<int> fresh(static_cast<std::size_t>(mesh.point_count()), -1), kept;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    if (cells.count(c)) continue;
    std::array<int, 4> ids;
    for (std::size_t i = 0; i < 4; ++i) {
      int& id = fresh[static_cast<std::size_t>(mesh.cell(c)[i])];
      if (id < 0) id = static_cast<int>(kept.size()), kept.push_back(mesh.cell(c)[i]);
      ids[i] = id;
    }
    out.add_cell(CellKind::tet4, ids.data(), mesh.region(c));
  }
  out.points.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) out.points.row(static_cast<Eigen::Index>(i)) = mesh.points.row(kept[i]);
  return out;
}

}  // namespace

long drop_flat(Mesh& mesh) {
  long dropped = 0;
  for (;;) {
    const std::set<int> cells = removable_cells(mesh);
    if (cells.empty()) return dropped;
    mesh = without(mesh, cells);
    dropped += static_cast<long>(cells.size());
  }
}

long count_flat(const Mesh& mesh) { return static_cast<long>(flat_cells(mesh).size()); }

}  // namespace msml::operators
