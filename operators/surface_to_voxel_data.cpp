// SPDX-License-Identifier: GPL-3.0-or-later
// SurfaceToVoxelDataOperator: a closed surface as a smoothed grey image.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <cmath>

#include "msml/core/operator.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"
#include "operators/vtk_voxelize.hpp"

namespace msml::operators {

Operator surface_to_voxel_data();

namespace {

constexpr double kernel_radius = 3;  // in standard deviations: 99.7 % of the weight

Image as_float(Image image) {
  std::vector<float> values;
  std::visit([&](const auto& voxels) { values.assign(voxels.begin(), voxels.end()); }, image.voxels);
  image.voxels = std::move(values);
  return image;
}

Image smoothed(const Image& image, double deviation) {
  const vtkNew<vtkImageGaussianSmooth> smooth;
  smooth->SetInputData(to_vtk(image));
  smooth->SetDimensionality(3);
  smooth->SetStandardDeviation(deviation);
  smooth->SetRadiusFactor(kernel_radius);
  update(*smooth, "smoothing the image");
  return to_image(*smooth->GetOutput());
}

}  // namespace

Operator surface_to_voxel_data() {
  Operator op("SurfaceToVoxelDataOperator",
              "A closed surface as a grey image: 255 inside, 0 outside, blurred in between by a Gaussian.");
  op.source("vtkPolyDataToImageStencil, vtkImageGaussianSmooth");
  op.note(
      "The longest side of the surface is divided into 2^accuracy_level cubic voxels. The level surface at 127.5 "
      "is the smoothed object.");
  op.note("MSML did not mark targetImageFilename as a target and did not say what accuracy_level counts.");
  const auto surface = op.input<Surface>("surfaceMesh", "closed");
  const auto level = op.parameter(
      "accuracy_level", {.range = closed(1, 11), .fallback = 8.0, .doc = "log2 of the voxels along the longest side"});
  const auto deviation = op.parameter("smoothing", {.unit = "voxels",
                                                    .range = closed(0, 100),
                                                    .fallback = 2.0,
                                                    .doc = "standard deviation of the Gaussian; 0 = not smoothed"});
  const auto image = op.output<Image>("image", "float, 0 to 255");
  op.target("targetImageFilename", image, "file to write the image to");
  op.run([=](Context& c) {
    const Surface& closed = c.get(surface);
    if (const Seams seams = seams_of(closed); seams.open > 0)
      throw Error(
          fmt::format("the surface is not closed: {} edges belong to one triangle only (the first at {:.6g} "
                      "{:.6g} {:.6g})",
                      seams.open, seams.where[0], seams.where[1], seams.where[2]));
    const double voxel = longest_side(closed) / std::exp2(c.get(level));
    const double sigma = c.get(deviation);
    // Twice the kernel: VTK raises the weights of a kernel that the border cuts, so none of these may see the object.
    const double margin = 2 * voxel * std::ceil(kernel_radius * sigma);
    Image binary = as_float(filled(closed, grid_around(closed, voxel, margin)));
    c.set(image, sigma > 0 ? smoothed(binary, sigma) : std::move(binary));
  });
  return op;
}

}  // namespace msml::operators
