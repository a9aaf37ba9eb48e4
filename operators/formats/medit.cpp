// SPDX-License-Identifier: GPL-3.0-or-later
// Medit's .mesh in ASCII: linear cells with one reference number each.
#include <fmt/format.h>

#include <iterator>
#include <map>

#include "operators/formats/formats.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

const std::map<std::string_view, CellKind>& cell_sections() {
  static const std::map<std::string_view, CellKind> sections{
      {"Edges", CellKind::line2}, {"Triangles", CellKind::tri3}, {"Tetrahedra", CellKind::tet4}};
  return sections;
}

/// Sections without cells, and how many numbers each of their entries has.
const std::map<std::string_view, int>& skipped_sections() {
  static const std::map<std::string_view, int> sections{
      {"Corners", 1},       {"RequiredVertices", 1},  {"Ridges", 1},
      {"RequiredEdges", 1}, {"RequiredTriangles", 1}, {"Normals", 3},
      {"Tangents", 3},      {"NormalAtVertices", 2},  {"TangentAtVertices", 2}};
  return sections;
}

void read_vertices(Scanner& in, int dimension, Mesh& mesh) {
  if (mesh.point_count() > 0) throw Error("has two sections Vertices");
  mesh.points.setZero(in.count(), 3);
  for (int i = 0; i < mesh.point_count(); ++i) {
    for (int d = 0; d < dimension; ++d) mesh.points(i, d) = in.number();
    in.number();  // the reference of a point means nothing here, and some programs write it as a real
  }
}

void read_cells(Scanner& in, CellKind kind, Mesh& mesh) {
  const int count = in.count();
  std::array<int, 10> ids{};
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < node_count(kind); ++k) {
      const long long id = in.integer();
      if (id < 1 || id > mesh.point_count())
        throw Error(fmt::format("line {}: {} names vertex {}, but there are vertices 1 to {}", in.line_number(),
                                name(kind), id, mesh.point_count()));
      ids[static_cast<std::size_t>(k)] = static_cast<int>(id - 1);
    }
    mesh.add_cell(kind, ids.data(), static_cast<int>(in.integer()));
  }
}

Mesh parse(const std::string& text) {
  Scanner in(text, true);
  Mesh mesh;
  int dimension = 3;
  if (in.word() != "MeshVersionFormatted") throw Error("is no Medit mesh in ASCII: MeshVersionFormatted is missing");
  in.integer();
  while (!in.at_end()) {
    const std::string_view section = in.word();
    if (section == "End") return mesh;
    if (section == "Dimension") {
      dimension = static_cast<int>(in.integer());
      if (dimension != 2 && dimension != 3) throw Error(fmt::format("Dimension is {}, not 2 or 3", dimension));
    } else if (section == "Vertices") {
      read_vertices(in, dimension, mesh);
    } else if (const auto cells = cell_sections().find(section); cells != cell_sections().end()) {
      read_cells(in, cells->second, mesh);
    } else if (const auto skipped = skipped_sections().find(section); skipped != skipped_sections().end()) {
      for (long long i = static_cast<long long>(in.count()) * skipped->second; i > 0; --i) in.number();
    } else {
      throw Error(fmt::format("line {}: section '{}' cannot be read; cells can be Edges, Triangles and Tetrahedra",
                              in.line_number(), section.substr(0, 40)));
    }
  }
  throw Error("ends without the word End; it may be cut off");
}

std::string written(const Mesh& mesh) {
  mesh.check();
  for (const CellKind kind : mesh.kinds)
    if (kind != CellKind::line2 && kind != CellKind::tri3 && kind != CellKind::tet4)
      throw Error(fmt::format("a Medit mesh cannot hold {}; .vtu and .msh can", name(kind)));
  std::string text = fmt::format("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", mesh.point_count());
  const auto out = std::back_inserter(text);
  for (int i = 0; i < mesh.point_count(); ++i)
    fmt::format_to(out, "{} {} {} 0\n", mesh.points(i, 0), mesh.points(i, 1), mesh.points(i, 2));
  for (const auto& [section, kind] : cell_sections()) {
    if (mesh.count(kind) == 0) continue;
    fmt::format_to(out, "{}\n{}\n", section, mesh.count(kind));
    for (int c = 0; c < mesh.cell_count(); ++c) {
      if (mesh.kinds[static_cast<std::size_t>(c)] != kind) continue;
      for (int k = 0; k < node_count(kind); ++k) fmt::format_to(out, "{} ", mesh.cell(c)[k] + 1);
      fmt::format_to(out, "{}\n", mesh.regions.empty() ? 0 : mesh.regions[static_cast<std::size_t>(c)]);
    }
  }
  return text + "End\n";
}

}  // namespace

Format medit() {
  return mesh_text_format(
      ".mesh",
      "Medit mesh in ASCII: edges, triangles and tetrahedra; references are region ids, fields are not kept. Cells are "
      "grouped by kind.",
      parse, written);
}

}  // namespace msml::operators
