// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and surfaces to and from VTK.
#include "operators/vtk_convert.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>
#include <optional>

#include "msml/core/error.hpp"
#include "operators/vtk_fields.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

vtkSmartPointer<vtkPoints> to_vtk(const Points& points) {
  auto out = vtkSmartPointer<vtkPoints>::New();
  out->SetDataTypeToDouble();
  out->SetNumberOfPoints(points.rows());
  auto* const array = vtkDoubleArray::SafeDownCast(out->GetData());
  std::copy(points.data(), points.data() + points.size(), array->GetPointer(0));
  return out;
}

Points points_of(vtkPointSet& set) {
  Points points(set.GetNumberOfPoints(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) set.GetPoint(i, points.data() + 3 * i);
  return points;
}

/// Cell kinds by VTK's cell type number.
std::optional<CellKind> kind_of(int vtk) {
  for (int k = 0; k <= static_cast<int>(CellKind::tet10); ++k)
    if (vtk_type(static_cast<CellKind>(k)) == vtk) return static_cast<CellKind>(k);
  return std::nullopt;
}

std::string plain_name(int vtk) {
  std::string text = vtkCellTypes::GetClassNameFromTypeId(vtk);
  return text.starts_with("vtk") ? text.substr(3) : text;
}

[[noreturn]] void refuse(const std::map<int, int>& unsupported) {
  std::vector<std::string> parts;
  for (const auto& [type, count] : unsupported)
    parts.push_back(fmt::format("{} {} (VTK cell type {})", with_commas(count), plain_name(type), type));
  throw Error(
      fmt::format("holds {}; cells can be Vertex, Line, QuadraticEdge, Triangle, QuadraticTriangle, Tetra and "
                  "QuadraticTetra",
                  fmt::join(parts, ", ")));
}

/// Throws Error unless the cells are stored consistently, so that walking over them stays inside the arrays.
void check_storage(vtkCellArray& cells) {
  vtkDataArray& offsets = *cells.GetOffsetsArray();
  const auto length = static_cast<double>(cells.GetConnectivityArray()->GetNumberOfValues());
  const vtkIdType n = offsets.GetNumberOfValues();
  double last = 0;
  for (vtkIdType i = 0; i < n; ++i) {
    const double next = offsets.GetComponent(i, 0);
    if ((i == 0 && next != 0) || next < last || next > length)
      throw Error(fmt::format("offset {} of the cells is {}, not between {} and {}", i, next, last, length));
    last = next;
  }
}

/// Appends the cells of one array; `type_at` gives the VTK type of the cell at a position of this array.
template <class TypeAt>
void append_cells(vtkCellArray& cells, TypeAt type_at, Mesh& mesh, std::map<int, int>& unsupported) {
  check_storage(cells);
  const vtkNew<vtkIdList> ids;
  std::vector<int> nodes;
  for (vtkIdType i = 0; i < cells.GetNumberOfCells(); ++i) {
    cells.GetCellAtId(i, ids);
    const int type = type_at(i, ids->GetNumberOfIds());
    const auto kind = kind_of(type);
    if (!kind) {
      ++unsupported[type];
      continue;
    }
    if (ids->GetNumberOfIds() != node_count(*kind))
      throw Error(fmt::format("cell {} is a {} with {} points", mesh.cell_count(), name(*kind), ids->GetNumberOfIds()));
    nodes.assign(ids->begin(), ids->end());
    mesh.add_cell(*kind, nodes.data());
  }
}

Mesh finish(Mesh mesh, vtkPointSet& set) {
  mesh.point_fields = fields_of(*set.GetPointData(), static_cast<std::size_t>(mesh.point_count()), "point");
  mesh.cell_fields = fields_of(*set.GetCellData(), mesh.kinds.size(), "cell");
  mesh.regions = take_regions(mesh.cell_fields);
  mesh.check();
  return mesh;
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> to_vtk(const Mesh& mesh) {
  mesh.check();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(to_vtk(mesh.points));
  const vtkNew<vtkCellArray> cells;
  cells->AllocateExact(mesh.cell_count(), static_cast<vtkIdType>(mesh.nodes.size()));
  const vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(mesh.cell_count());
  std::vector<vtkIdType> ids;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    ids.assign(mesh.cell(c), mesh.cell(c) + node_count(kind));
    cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    types->SetValue(c, static_cast<unsigned char>(vtk_type(kind)));
  }
  grid->SetCells(types, cells);
  add_fields(mesh.point_fields, static_cast<std::size_t>(mesh.point_count()), "point", *grid->GetPointData());
  add_fields(mesh.cell_fields, mesh.kinds.size(), "cell", *grid->GetCellData());
  if (!mesh.regions.empty()) {
    const vtkNew<vtkIntArray> regions;
    regions->SetName("region");
    regions->SetNumberOfValues(mesh.cell_count());
    std::copy(mesh.regions.begin(), mesh.regions.end(), regions->GetPointer(0));
    grid->GetCellData()->SetScalars(regions);
  }
  return grid;
}

vtkSmartPointer<vtkPolyData> to_vtk(const Surface& surface) {
  surface.check();
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(to_vtk(surface.points));
  const vtkNew<vtkCellArray> cells;
  for (const auto& triangle : surface.triangles) {
    const std::array<vtkIdType, 3> ids{triangle[0], triangle[1], triangle[2]};
    cells->InsertNextCell(3, ids.data());
  }
  data->SetPolys(cells);
  add_fields(surface.point_fields, static_cast<std::size_t>(surface.point_count()), "point", *data->GetPointData());
  add_fields(surface.cell_fields, surface.triangles.size(), "cell", *data->GetCellData());
  return data;
}

Mesh to_mesh(vtkUnstructuredGrid& grid) {
  Mesh mesh;
  mesh.points = points_of(grid);
  std::map<int, int> unsupported;
  if (vtkCellArray* const cells = grid.GetCells(); cells != nullptr) {
    vtkUnsignedCharArray* const types = grid.GetCellTypesArray();
    if (types == nullptr || types->GetNumberOfValues() != cells->GetNumberOfCells())
      throw Error(
          fmt::format("{} cell types for {} cells", types ? types->GetNumberOfValues() : 0, cells->GetNumberOfCells()));
    append_cells(
        *cells, [&](vtkIdType i, vtkIdType) { return types->GetValue(i); }, mesh, unsupported);
  }
  if (!unsupported.empty()) refuse(unsupported);
  return finish(std::move(mesh), grid);
}

Mesh to_mesh(vtkPolyData& data) {
  Mesh mesh;
  mesh.points = points_of(data);
  std::map<int, int> unsupported;
  const auto vertices = [](vtkIdType, vtkIdType n) { return n == 1 ? VTK_VERTEX : VTK_POLY_VERTEX; };
  const auto lines = [](vtkIdType, vtkIdType n) { return n == 2 ? VTK_LINE : VTK_POLY_LINE; };
  const auto polygons = [](vtkIdType, vtkIdType n) { return n == 3 ? VTK_TRIANGLE : n == 4 ? VTK_QUAD : VTK_POLYGON; };
  const auto strips = [](vtkIdType, vtkIdType) { return VTK_TRIANGLE_STRIP; };
  append_cells(*data.GetVerts(), vertices, mesh, unsupported);
  append_cells(*data.GetLines(), lines, mesh, unsupported);
  append_cells(*data.GetPolys(), polygons, mesh, unsupported);
  append_cells(*data.GetStrips(), strips, mesh, unsupported);
  if (!unsupported.empty()) refuse(unsupported);
  return finish(std::move(mesh), data);
}

Surface to_surface(vtkPolyData& data) {
  const vtkIdType others = data.GetNumberOfVerts() + data.GetNumberOfLines();
  if (others > 0)
    throw Error(fmt::format("holds {} vertices and lines; a Surface holds triangles only", with_commas(others)));
  Mesh mesh;
  check_storage(*data.GetPolys());
  check_storage(*data.GetStrips());
  const bool only_triangles = data.GetNumberOfStrips() == 0 && data.GetPolys()->IsHomogeneous() == 3;
  if (only_triangles || data.GetNumberOfCells() == 0) return to_surface(to_mesh(data));
  for (vtkCellArray* const cells : {data.GetPolys(), data.GetStrips()}) {
    std::array<double, 2> range{0, 0};
    if (cells->GetNumberOfConnectivityIds() > 0) cells->GetConnectivityArray()->GetRange(range.data(), 0);
    if (range[0] < 0 || (cells->GetNumberOfCells() > 0 && range[1] >= static_cast<double>(data.GetNumberOfPoints())))
      throw Error(fmt::format("a polygon names point {}, but there are points 0 to {}",
                              range[0] < 0 ? range[0] : range[1], data.GetNumberOfPoints() - 1));
  }
  const vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(&data);
  update(*filter, "cutting polygons into triangles");
  return to_surface(to_mesh(*filter->GetOutput()));
}

Surface to_surface(const Mesh& mesh) {
  Surface surface;
  const int others = mesh.cell_count() - mesh.count(CellKind::tri3);
  if (others > 0)
    throw Error(fmt::format("holds {}, not triangles alone, so it is no Surface; ExtractSurfaceMesh makes one of it",
                            mesh.summary()));
  surface.points = mesh.points;
  surface.triangles.reserve(mesh.kinds.size());
  for (int c = 0; c < mesh.cell_count(); ++c)
    surface.triangles.push_back({mesh.cell(c)[0], mesh.cell(c)[1], mesh.cell(c)[2]});
  surface.point_fields = mesh.point_fields;
  surface.cell_fields = mesh.cell_fields;
  if (!mesh.regions.empty())
    surface.cell_fields.push_back({.name = "region", .values = {mesh.regions.begin(), mesh.regions.end()}});
  return surface;
}

}  // namespace msml::operators
