// SPDX-License-Identifier: GPL-3.0-or-later
// Cell tables and checks of meshes and surfaces.
#include "msml/core/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "msml/core/error.hpp"

namespace msml {
namespace {

struct CellFacts {
  const char* name;
  int nodes, dimension, vtk;
};
constexpr std::array<CellFacts, 7> facts{{{"vertex", 1, 0, 1},
                                          {"line2", 2, 1, 3},
                                          {"line3", 3, 1, 21},
                                          {"tri3", 3, 2, 5},
                                          {"tri6", 6, 2, 22},
                                          {"tet4", 4, 3, 10},
                                          {"tet10", 10, 3, 24}}};
const CellFacts& of(CellKind kind) { return facts[static_cast<std::size_t>(kind)]; }

void check_points(const Points& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!points.row(i).allFinite())
      throw Error(fmt::format("point {} is not finite: ({} {} {})", i, points(i, 0), points(i, 1), points(i, 2)));
}

void check_fields(const std::vector<Field>& fields, std::size_t count, const char* what) {
  for (const Field& field : fields)
    if (field.components < 1 || field.values.size() != count * static_cast<std::size_t>(field.components))
      throw Error(fmt::format("{} field '{}' has {} values for {} {}s of {} components", what, field.name,
                              field.values.size(), count, what, field.components));
}

void check_node(int node, int count, std::size_t cell) {
  if (node < 0 || node >= count)
    throw Error(fmt::format("cell {} names point {}, but the mesh has points 0 to {}", cell, node, count - 1));
}

}  // namespace

const std::array<std::array<int, 6>, 4> tet_faces{
    {{1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}}};

int side_count(CellKind kind) { return dimension(kind) == 0 ? 0 : dimension(kind) + 1; }

CellKind side_kind(CellKind kind) {
  switch (kind) {
    case CellKind::tet10:
      return CellKind::tri6;
    case CellKind::tet4:
      return CellKind::tri3;
    case CellKind::tri6:
      return CellKind::line3;
    case CellKind::tri3:
      return CellKind::line2;
    default:
      return CellKind::vertex;
  }
}

std::span<const int> side_nodes(CellKind kind, int side) {
  static constexpr std::array<std::array<int, 3>, 3> triangle{{{0, 1, 3}, {1, 2, 4}, {2, 0, 5}}};
  static constexpr std::array<int, 2> line{0, 1};
  const std::size_t s = static_cast<std::size_t>(side), count = static_cast<std::size_t>(node_count(side_kind(kind)));
  if (dimension(kind) == 3) return std::span<const int>(tet_faces[s]).first(count);
  if (dimension(kind) == 2) return std::span<const int>(triangle[s]).first(count);
  return std::span<const int>(line).subspan(s, 1);
}

int node_count(CellKind kind) { return of(kind).nodes; }
int dimension(CellKind kind) { return of(kind).dimension; }
int corner_count(CellKind kind) { return of(kind).dimension + 1; }
const char* name(CellKind kind) { return of(kind).name; }
int vtk_type(CellKind kind) { return of(kind).vtk; }

const char* name(Indexed kind) {
  constexpr std::array<const char*, 3> names{"nodes", "elements", "faces"};
  return names[static_cast<std::size_t>(kind)];
}

int Mesh::add_cell(CellKind kind, const int* ids, int region) {
  const int id = cell_count();
  if (region != 0 && regions.empty()) regions.assign(kinds.size(), 0);
  if (region != 0 || !regions.empty()) regions.push_back(region);
  kinds.push_back(kind);
  nodes.insert(nodes.end(), ids, ids + node_count(kind));
  offsets.push_back(static_cast<int>(nodes.size()));
  return id;
}

int Mesh::count(CellKind kind) const { return static_cast<int>(std::count(kinds.begin(), kinds.end(), kind)); }

std::string Mesh::summary() const {
  std::string text = with_commas(point_count()) + " points";
  for (std::size_t k = facts.size(); k-- > 0;) {
    const int n = count(static_cast<CellKind>(k));
    if (n > 0) text += fmt::format(", {} {}", with_commas(n), facts[k].name);
  }
  return text;
}

void Mesh::check() const {
  check_points(points);
  if (offsets.size() != kinds.size() + 1 || offsets.front() != 0 || offsets.back() != static_cast<int>(nodes.size()))
    throw Error("cell offsets do not fit the cells");
  for (std::size_t c = 0; c < kinds.size(); ++c) {
    if (offsets[c + 1] - offsets[c] != node_count(kinds[c]))
      throw Error(fmt::format("cell {} is a {} with {} nodes", c, name(kinds[c]), offsets[c + 1] - offsets[c]));
    for (int i = offsets[c]; i < offsets[c + 1]; ++i) check_node(nodes[static_cast<std::size_t>(i)], point_count(), c);
  }
  if (!regions.empty() && regions.size() != kinds.size())
    throw Error(fmt::format("{} region ids for {} cells", regions.size(), kinds.size()));
  check_fields(point_fields, static_cast<std::size_t>(point_count()), "point");
  check_fields(cell_fields, kinds.size(), "cell");
}

std::string Surface::summary() const {
  return fmt::format("{} points, {} triangles", with_commas(point_count()), with_commas(triangle_count()));
}

void Surface::check() const {
  check_points(points);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int node : triangles[t]) check_node(node, point_count(), t);
  check_fields(point_fields, static_cast<std::size_t>(point_count()), "point");
  check_fields(cell_fields, triangles.size(), "cell");
}

Mesh to_mesh(const Surface& surface) {
  Mesh mesh;
  mesh.points = surface.points;
  for (const auto& triangle : surface.triangles) mesh.add_cell(CellKind::tri3, triangle.data());
  mesh.point_fields = surface.point_fields;
  mesh.cell_fields = surface.cell_fields;
  return mesh;
}

std::string with_commas(long long value) {
  std::string digits = std::to_string(value);
  const std::size_t first = value < 0 ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) digits.insert(i -= 3, 1, ',');
  return digits;
}

}  // namespace msml
