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
  double longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) longest = std::max(longest, (p.row(i) - p.row(j)).norm());
  return std::abs(volume(p)) < 1e-4 * std::pow(longest, 3);
}

using Edge = std::pair<int, int>;
Edge edge(int a, int b) { return std::minmax(a, b); }

/// What the boundary holds: its edges, and for each cell in it the local numbers of its outer faces.
struct Boundary {
  std::set<Edge> edges;
  std::map<int, std::vector<int>> faces;
};

Boundary boundary_of(const Mesh& mesh) {
  Boundary boundary;
  for (const auto& [cell, local] : outer_faces(mesh)) {
    boundary.faces[cell].push_back(local);
    const auto& f = tet_faces[static_cast<std::size_t>(local)];
    for (std::size_t i = 0; i < 3; ++i)
      boundary.edges.insert(edge(mesh.cell(cell)[f[i]], mesh.cell(cell)[f[(i + 1) % 3]]));
  }
  return boundary;
}

/// A cell with three outer faces leaves its fourth; one with two leaves an edge that the boundary must not have yet.
bool removable(const Mesh& mesh, const Boundary& boundary, int cell, const std::vector<int>& outer) {
  if (outer.size() == 3) return true;
  const int* nodes = mesh.cell(cell);  // face i lies opposite corner i
  return outer.size() == 2 && !boundary.edges.count(edge(nodes[outer[0]], nodes[outer[1]]));
}

/// Flat cells that can go together: none shares a point with another.
std::set<int> removable_cells(const Mesh& mesh) {
  const Boundary boundary = boundary_of(mesh);
  std::set<int> cells, touched;
  for (const auto& [cell, outer] : boundary.faces) {
    const int* nodes = mesh.cell(cell);
    if (!flat(mesh, cell) || !removable(mesh, boundary, cell, outer)) continue;
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

long count_flat(const Mesh& mesh) {
  long count = 0;
  for (int c = 0; c < mesh.cell_count(); ++c) count += flat(mesh, c);
  return count;
}

}  // namespace msml::operators
