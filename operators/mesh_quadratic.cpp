// SPDX-License-Identifier: GPL-3.0-or-later
// Mid nodes on edges, and their projection onto a surface.
#include "operators/mesh_quadratic.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

using Edge = std::array<int, 2>;

/// Edges of the linear cells in the order of the mid nodes of the quadratic ones.
const std::vector<Edge>& edges_of(CellKind kind) {
  static const std::vector<Edge> none, line{{0, 1}}, triangle{{0, 1}, {1, 2}, {2, 0}},
      tetrahedron{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  if (kind == CellKind::line2) return line;
  if (kind == CellKind::tri3) return triangle;
  return kind == CellKind::tet4 ? tetrahedron : none;
}

CellKind quadratic(CellKind kind) {
  if (kind == CellKind::line2) return CellKind::line3;
  if (kind == CellKind::tri3) return CellKind::tri6;
  return kind == CellKind::tet4 ? CellKind::tet10 : kind;
}

/// Ids of mid nodes by the ends of their edges, in order of first use.
class MidNodes {
 public:
  explicit MidNodes(int first) : next_(first) {}
  int id(int a, int b) {
    if (a > b) std::swap(a, b);
    const auto key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
    const auto [entry, fresh] = ids_.try_emplace(key, next_);
    if (fresh) ends.push_back({a, b}), ++next_;
    return entry->second;
  }
  std::vector<Edge> ends;

 private:
  std::unordered_map<std::uint64_t, int> ids_;
  int next_;
};

void append_means(Field& field, const std::vector<Edge>& ends) {
  const auto width = static_cast<std::size_t>(field.components);
  for (const auto& [a, b] : ends)
    for (std::size_t i = 0; i < width; ++i)
      field.values.push_back((field.values[static_cast<std::size_t>(a) * width + i] +
                              field.values[static_cast<std::size_t>(b) * width + i]) /
                             2);
}

/// The mid node's place on a straight edge, for every mid node of the tet10 cells.
std::map<int, Edge> mid_nodes(const Mesh& mesh, int cell) {
  std::map<int, Edge> found;
  const int* nodes = mesh.cell(cell);
  const auto& edges = edges_of(CellKind::tet4);
  for (std::size_t e = 0; e < edges.size(); ++e) found[nodes[4 + e]] = {nodes[edges[e][0]], nodes[edges[e][1]]};
  return found;
}

bool sound(const Mesh& mesh, int cell) {
  const auto nodes = nodes_of(mesh, cell);
  return jacobian_bound(nodes) > 0.01 * 6 * std::abs(curved_volume(nodes));
}

}  // namespace

Mesh to_quadratic(const Mesh& mesh, const MidPoint& mid) {
  MidNodes mids(mesh.point_count());
  Mesh out;
  out.regions = mesh.regions;
  out.cell_fields = mesh.cell_fields;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    const int* nodes = mesh.cell(c);
    out.nodes.insert(out.nodes.end(), nodes, nodes + node_count(kind));
    for (const auto& [a, b] : edges_of(kind)) out.nodes.push_back(mids.id(nodes[a], nodes[b]));
    out.kinds.push_back(quadratic(kind));
    out.offsets.push_back(static_cast<int>(out.nodes.size()));
  }
  const int count = mesh.point_count();
  out.points.resize(count + static_cast<int>(mids.ends.size()), 3);
  out.points.topRows(count) = mesh.points;
  for (int n = 0; const auto& [a, b] : mids.ends) {
    const Vec3 pa = mesh.points.row(a), pb = mesh.points.row(b);
    out.points.row(count + n++) = mid ? mid(pa, pb) : Vec3((pa + pb) / 2);
  }
  out.point_fields = mesh.point_fields;
  for (Field& field : out.point_fields) append_means(field, mids.ends);
  return out;
}

Projection project_mid_nodes(Mesh& mesh, const std::function<Vec3(const Vec3&)>& nearest) {
  std::map<int, Vec3> straight;  // mid nodes now bent, with the place they came from
  Projection done;
  for (const auto& [cell, local] : outer_faces(mesh)) {
    if (mesh.kinds[static_cast<std::size_t>(cell)] != CellKind::tet10) continue;
    for (std::size_t i = 3; i < 6; ++i) {
      const int node = mesh.cell(cell)[tet_faces[static_cast<std::size_t>(local)][i]];
      const Vec3 from = mesh.points.row(node);
      if (!straight.try_emplace(node, from).second) continue;
      const Vec3 to = nearest(from);
      done.farthest = std::max(done.farthest, (to - from).norm());
      mesh.points.row(node) = to;
    }
  }
  const long tried = static_cast<long>(straight.size());
  // Straightening one element changes its neighbours, so look again until nothing more goes back.
  for (bool again = true; again;) {
    again = false;
    for (int c = 0; c < mesh.cell_count(); ++c) {
      if (mesh.kinds[static_cast<std::size_t>(c)] != CellKind::tet10 || sound(mesh, c)) continue;
      for (const auto& [node, ends] : mid_nodes(mesh, c)) {
        const auto bent = straight.find(node);
        if (bent == straight.end()) continue;
        mesh.points.row(node) = bent->second;
        straight.erase(bent);
        again = true;
      }
    }
  }
  done.moved = static_cast<long>(straight.size());
  done.kept_straight = tried - done.moved;
  return done;
}

}  // namespace msml::operators
