// SPDX-License-Identifier: GPL-3.0-or-later
// Fills closed surfaces with voxels through vtkPolyDataToImageStencil.
#include "operators/vtk_voxelize.hpp"

#include <fmt/format.h>
#include <vtkCleanPolyData.h>
#include <vtkFillHolesFilter.h>
#include <vtkImageData.h>
#include <vtkImageStencilToImage.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataToImageStencil.h>
#include <vtkSmartPointer.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "msml/core/error.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

vtkSmartPointer<vtkPolyData> joined(const Surface& surface) {
  const vtkNew<vtkCleanPolyData> clean;
  const Surface plain{.points = surface.points, .triangles = surface.triangles, .point_fields = {}, .cell_fields = {}};
  clean->SetInputData(to_vtk(plain));
  clean->SetTolerance(0);
  clean->ConvertPolysToLinesOff();
  clean->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  update(*clean, "joining points");
  return clean->GetOutput();
}

void require_points(const Surface& surface) {
  if (surface.triangles.empty()) throw Error("the surface has no triangles");
}

}  // namespace

Seams seams_of(const Surface& surface) {
  const Surface whole = to_surface(*joined(surface));
  std::vector<std::array<int, 2>> edges;
  edges.reserve(3 * whole.triangles.size());
  for (const auto& t : whole.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  Seams seams;
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    while (next < edges.size() && edges[next] == edges[i]) ++next;
    if (next - i == 2) continue;
    const bool open = next - i == 1;
    if (open ? seams.open == 0 : seams.open + seams.crowded == 0)
      seams.where = 0.5 * (whole.points.row(edges[i][0]) + whole.points.row(edges[i][1]));
    ++(open ? seams.open : seams.crowded);
  }
  return seams;
}

Surface without_holes(const Surface& surface) {
  const auto whole = joined(surface);
  const vtkNew<vtkFillHolesFilter> fill;
  fill->SetInputData(whole);
  fill->SetHoleSize(1e3 * whole->GetLength());  // larger than any hole
  update(*fill, "filling holes");
  return to_surface(*fill->GetOutput());
}

double longest_side(const Surface& surface) {
  require_points(surface);
  const double side = (surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff()).maxCoeff();
  if (!(side > 0)) throw Error("all points of the surface are at one place");
  return side;
}

Image grid_around(const Surface& surface, double voxel, double margin) {
  require_points(surface);
  const Vec3 low = surface.points.colwise().minCoeff(), high = surface.points.colwise().maxCoeff();
  const Vec3 sides = (high - low).array() + 2 * margin;
  constexpr double almost = 1e-9;  // a side that is a multiple of the voxel takes exactly so many
  const Vec3 counts = (sides / voxel).unaryExpr([](double n) { return std::max(1.0, std::ceil(n - almost)) + 2; });
  constexpr double most = 2147483648.0;
  if (!(counts.prod() <= most))
    throw Error(fmt::format("an image of {:.6g} x {:.6g} x {:.6g} voxels is too large; the limit is 2^31 voxels",
                            counts[0], counts[1], counts[2]));
  const Vec3 origin = 0.5 * (low + high) - 0.5 * voxel * (counts.array() - 1).matrix();
  return make_image<std::uint8_t>(
      {static_cast<int>(counts[0]), static_cast<int>(counts[1]), static_cast<int>(counts[2])}, origin,
      Vec3::Constant(voxel));
}

Image filled(const Surface& surface, const Image& grid) {
  require_points(surface);
  Surface local{.points = surface.points, .triangles = surface.triangles, .point_fields = {}, .cell_fields = {}};
  const Mat3 turn = grid.direction.inverse();
  for (int i = 0; i < local.point_count(); ++i)
    local.points.row(i) = turn * (local.points.row(i).transpose() - grid.origin);
  const vtkNew<vtkPolyDataToImageStencil> stencil;
  stencil->SetInputData(to_vtk(local));
  stencil->SetOutputOrigin(0, 0, 0);
  Vec3 spacing = grid.spacing;
  stencil->SetOutputSpacing(spacing.data());
  stencil->SetOutputWholeExtent(0, grid.size[0] - 1, 0, grid.size[1] - 1, 0, grid.size[2] - 1);
  const vtkNew<vtkImageStencilToImage> image;
  image->SetInputConnection(stencil->GetOutputPort());
  image->SetOutsideValue(0);
  image->SetInsideValue(255);
  image->SetOutputScalarTypeToUnsignedChar();
  update(*image, "filling the surface with voxels");
  Image result = to_image(*image->GetOutput());
  result.origin = grid.origin;
  result.direction = grid.direction;
  return result;
}

}  // namespace msml::operators
