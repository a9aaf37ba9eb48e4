// SPDX-License-Identifier: GPL-3.0-or-later
// ExtractSurfaceMesh: the outer faces of a tetrahedral mesh as a triangle surface.
#include <algorithm>

#include "msml/core/operator.hpp"
#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

using Triangle = std::array<int, 3>;

/// One triangle of a tet4 face, or four of a tet10 face through its mid nodes.
std::vector<Triangle> triangles_of(const Mesh& mesh, const OuterFace& face) {
  const int* nodes = mesh.cell(face.cell);
  const auto& local = tet_faces[static_cast<std::size_t>(face.local)];
  const auto id = [&](std::size_t i) { return nodes[local[i]]; };
  if (mesh.kinds[static_cast<std::size_t>(face.cell)] == CellKind::tet4) return {{id(0), id(1), id(2)}};
  return {{id(0), id(3), id(5)}, {id(3), id(1), id(4)}, {id(5), id(4), id(2)}, {id(3), id(4), id(5)}};
}

std::vector<double> picked(const Field& field, const std::vector<int>& ids) {
  const auto width = static_cast<std::size_t>(field.components);
  std::vector<double> values;
  values.reserve(ids.size() * width);
  for (const int id : ids)
    for (std::size_t i = 0; i < width; ++i) values.push_back(field.values[static_cast<std::size_t>(id) * width + i]);
  return values;
}

Field numbers(std::string name, const std::vector<int>& ids) {
  return {std::move(name), 1, std::vector<double>(ids.begin(), ids.end())};
}

/// A second array of the same name would hide one of the two in the file.
bool ours(const Field& field) {
  return field.name == "originalPoint" || field.name == "originalCell" || field.name == "region";
}

Surface surface_of(const Mesh& mesh) {
  Surface surface;
  std::vector<int> fresh(static_cast<std::size_t>(mesh.point_count()), -1), points, cells, regions;
  for (const OuterFace& face : outer_faces(mesh))
    for (Triangle triangle : triangles_of(mesh, face)) {
      for (int& id : triangle) {
        int& now = fresh[static_cast<std::size_t>(id)];
        if (now < 0) now = static_cast<int>(points.size()), points.push_back(id);
        id = now;
      }
      surface.triangles.push_back(triangle);
      cells.push_back(face.cell);
      regions.push_back(mesh.region(face.cell));
    }
  surface.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    surface.points.row(static_cast<Eigen::Index>(i)) = mesh.points.row(points[i]);
  for (const Field& field : mesh.point_fields)
    if (!ours(field)) surface.point_fields.push_back({field.name, field.components, picked(field, points)});
  for (const Field& field : mesh.cell_fields)
    if (!ours(field)) surface.cell_fields.push_back({field.name, field.components, picked(field, cells)});
  surface.point_fields.push_back(numbers("originalPoint", points));
  surface.cell_fields.push_back(numbers("originalCell", cells));
  surface.cell_fields.push_back(numbers("region", regions));
  return surface;
}

}  // namespace

Operator extract_surface() {
  Operator op("ExtractSurfaceMesh", "The outer faces of a tetrahedral mesh, facing outwards.");
  op.source("faces that one tetrahedron alone has");
  const auto mesh = op.input<Mesh>("mesh", "tet4 or tet10");
  const auto surface =
      op.output<Surface>("surfaceOut",
                         "one triangle per tet4 face, four per tet10 face (through the mid nodes); point field "
                         "originalPoint, cell fields originalCell and region, and the fields of the mesh");
  op.target("targetSurfaceMeshFilename", surface, "file to write the surface to");
  op.run([=](Context& c) {
    require_tets(c.get(mesh), "ExtractSurfaceMesh");
    c.set(surface, surface_of(c.get(mesh)));
  });
  return op;
}

}  // namespace msml::operators
