// SPDX-License-Identifier: GPL-3.0-or-later
// vtkMarchingCube: the surface where an image takes one value.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <Eigen/LU>
#include <algorithm>

#include "msml/core/operator.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"
#include "operators/vtk_voxelize.hpp"

namespace msml::operators {

Operator marching_cubes();

namespace {

void require_crossing(const Image& image, double iso) {
  if (image.components != 1) throw Error(fmt::format("the image has {} components; one is needed", image.components));
  if (*std::min_element(image.size.begin(), image.size.end()) < 2)
    throw Error(fmt::format("the image of {} x {} x {} voxels is flat", image.size[0], image.size[1], image.size[2]));
  double low = image.at(0), high = low;
  for (std::size_t i = 1; i < image.voxel_count(); ++i) {
    low = std::min(low, image.at(i));
    high = std::max(high, image.at(i));
  }
  if (!(iso > low && iso <= high))
    throw Error(fmt::format("isoValue = {} is not above {} and at most {}, the values of the image", iso, low, high));
}

Surface level_surface(const Image& image, double iso) {
  require_crossing(image, iso);
  Image local = image;
  local.origin.setZero();
  local.direction.setIdentity();
  const vtkNew<vtkMarchingCubes> cubes;
  cubes->SetInputData(to_vtk(local));
  cubes->SetValue(0, iso);
  cubes->ComputeNormalsOff();
  cubes->ComputeGradientsOff();
  cubes->ComputeScalarsOff();
  update(*cubes, "vtkMarchingCube");
  Surface surface = to_surface(*cubes->GetOutput());
  for (int i = 0; i < surface.point_count(); ++i)
    surface.points.row(i) = image.origin + image.direction * surface.points.row(i).transpose();
  if (image.direction.determinant() < 0)
    for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  return surface;
}

}  // namespace

Operator marching_cubes() {
  Operator op("vtkMarchingCube", "The triangle surface where the image has the value isoValue, linear between voxels.");
  op.source("vtkMarchingCubes; Lorensen and Cline 1987, doi 10.1145/37402.37422");
  op.note(
      "Triangles face the lower values. An object that touches the border of the image gives an open surface, "
      "with a warning.");
  const auto image = op.input<Image>("image", "scalar, at least two voxels along each side");
  const auto iso = op.parameter("isoValue", {.doc = "above the least and at most the largest value of the image"});
  const auto surface = op.output<Surface>("targetsurface", "triangles, facing the lower values");
  op.target("outFilename", surface, "file to write the surface to");
  op.run([=](Context& c) {
    Surface made = level_surface(c.get(image), c.get(iso));
    if (const Seams seams = seams_of(made); seams.open > 0)
      c.reporter().warn(
          fmt::format("the surface is open along {} edges: the object touches the border of the image", seams.open));
    c.set(surface, std::move(made));
  });
  return op;
}

}  // namespace msml::operators
