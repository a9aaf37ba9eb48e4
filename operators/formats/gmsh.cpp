// SPDX-License-Identifier: GPL-3.0-or-later
// Gmsh's .msh, version 2.2 in ASCII (Gmsh reference manual, "MSH file format version 2").
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <unordered_map>

#include "operators/formats/formats.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

/// Gmsh's number of each CellKind, in the order of CellKind.
constexpr std::array<int, 7> gmsh_types{15, 1, 8, 2, 9, 4, 11};

std::optional<CellKind> kind_of(long long type) {
  const auto found = std::find(gmsh_types.begin(), gmsh_types.end(), type);
  if (found == gmsh_types.end()) return std::nullopt;
  return static_cast<CellKind>(found - gmsh_types.begin());
}

/// Gmsh numbers the mid nodes of a tet10 on 01 12 20 03 23 13, VTK on 01 12 20 03 13 23.
void swap_last_two(CellKind kind, int* ids) {
  if (kind == CellKind::tet10) std::swap(ids[8], ids[9]);
}

using NodeIds = std::unordered_map<long long, int>;

NodeIds read_nodes(Scanner& in, Mesh& mesh) {
  NodeIds ids;
  mesh.points.resize(in.count(), 3);
  for (int i = 0; i < mesh.point_count(); ++i) {
    const long long id = in.integer();
    if (!ids.emplace(id, i).second) throw Error(fmt::format("line {}: node {} appears twice", in.line_number(), id));
    for (int d = 0; d < 3; ++d) mesh.points(i, d) = in.number();
  }
  return ids;
}

void read_element(Scanner& in, const NodeIds& ids, CellKind kind, Mesh& mesh) {
  const int tags = in.count();
  int region = 0;
  for (int t = 0; t < tags; ++t) {
    const long long tag = in.integer();
    if (t == 0) region = static_cast<int>(tag);
  }
  std::array<int, 10> nodes{};
  for (int k = 0; k < node_count(kind); ++k) {
    const long long id = in.integer();
    const auto found = ids.find(id);
    if (found == ids.end()) throw Error(fmt::format("line {}: there is no node {}", in.line_number(), id));
    nodes[static_cast<std::size_t>(k)] = found->second;
  }
  swap_last_two(kind, nodes.data());
  mesh.add_cell(kind, nodes.data(), region);
}

void read_elements(Scanner& in, const NodeIds& ids, Mesh& mesh) {
  std::map<long long, int> unsupported;
  const int count = in.count();
  for (int i = 0; i < count; ++i) {
    in.integer();  // the element's own number; cells are numbered in file order
    const long long type = in.integer();
    if (const auto kind = kind_of(type)) {
      read_element(in, ids, *kind, mesh);
    } else {
      ++unsupported[type];
      in.line();
    }
  }
  if (unsupported.empty()) return;
  std::vector<std::string> parts;
  for (const auto& [type, n] : unsupported) parts.push_back(fmt::format("{} elements of Gmsh type {}", n, type));
  throw Error(fmt::format("holds {}; types can be {} (points, lines, triangles and tetrahedra up to second order)",
                          fmt::join(parts, ", "), fmt::join(gmsh_types, " ")));
}

void read_version(Scanner& in) {
  const std::string_view version = in.word();
  if (!version.starts_with("2.") || in.integer() != 0)
    throw Error(fmt::format("is of version {} or binary; only 2.2 in ASCII can be read (gmsh -format msh22)",
                            version.substr(0, 10)));
}

/// Moves behind the line "$End…" of a section that is not needed.
void skip(Scanner& in, std::string_view section) {
  const std::string end = "$End" + std::string(section.substr(1));
  while (in.word() != end) {
  }
}

Mesh parse(const std::string& text) {
  Scanner in(text);
  Mesh mesh;
  NodeIds ids;
  if (in.word() != "$MeshFormat") throw Error("is no Gmsh file: it does not begin with $MeshFormat");
  read_version(in);
  skip(in, "$MeshFormat");
  bool elements = false;
  while (!in.at_end()) {
    const std::string_view section = in.word();
    if (!section.starts_with("$")) throw Error(fmt::format("line {}: a section was expected", in.line_number()));
    if (section == "$Nodes") ids = read_nodes(in, mesh);
    if (section == "$Elements") read_elements(in, ids, mesh), elements = true;
    skip(in, section);
  }
  if (!elements) throw Error("has no section $Elements; it may be cut off");
  return mesh;
}

std::string written(const Mesh& mesh) {
  mesh.check();
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.point_count());
  const auto out = std::back_inserter(text);
  for (int i = 0; i < mesh.point_count(); ++i)
    fmt::format_to(out, "{} {} {} {}\n", i + 1, mesh.points(i, 0), mesh.points(i, 1), mesh.points(i, 2));
  fmt::format_to(out, "$EndNodes\n$Elements\n{}\n", mesh.cell_count());
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const auto cell = static_cast<std::size_t>(c);
    const CellKind kind = mesh.kinds[cell];
    const int region = mesh.regions.empty() ? 0 : mesh.regions[cell];
    std::vector<int> nodes(mesh.cell(c), mesh.cell(c) + node_count(kind));
    swap_last_two(kind, nodes.data());
    for (int& node : nodes) ++node;
    fmt::format_to(out, "{} {} 2 {} {} {}\n", c + 1, gmsh_types[static_cast<std::size_t>(kind)], region, region,
                   fmt::join(nodes, " "));
  }
  return text + "$EndElements\n";
}

}  // namespace

Format gmsh() {
  return mesh_text_format(".msh",
                          "Gmsh 2.2 in ASCII: points, lines, triangles and tetrahedra up to second order; the first "
                          "tag (physical group) is the "
                          "region id, fields are not kept.",
                          parse, written);
}

}  // namespace msml::operators
