// SPDX-License-Identifier: GPL-3.0-or-later
// VoxelizeSurfaceMesh: a closed surface as a binary image.
#include <fmt/format.h>

#include "msml/core/operator.hpp"
#include "operators/early_checks.hpp"
#include "operators/vtk_voxelize.hpp"

namespace msml::operators {

Operator voxelize_surface();

namespace {

/// The surface itself where it is closed, else with its holes capped; Error where that is not wanted or fails.
Surface closed_surface(const Surface& surface, bool fill_holes, Reporter& reporter) {
  const Seams seams = seams_of(surface);
  const auto faults = [](const Seams& s) {
    return fmt::format(
        "{} edges belong to one triangle only and {} to more than two (the first at {:.6g} {:.6g} {:.6g})", s.open,
        s.crowded, s.where[0], s.where[1], s.where[2]);
  };
  if (seams.open == 0) return surface;
  if (!fill_holes) throw Error("the surface is not closed: " + faults(seams));
  Surface whole = without_holes(surface);
  if (const Seams left = seams_of(whole); left.open > 0)
    throw Error("the surface is not closed even after filling its holes: " + faults(left));
  reporter.warn(fmt::format("the surface was not closed: {}; its holes are filled with {} triangles", faults(seams),
                            whole.triangle_count() - surface.triangle_count()));
  return whole;
}

}  // namespace

Operator voxelize_surface() {
  Operator op("VoxelizeSurfaceMesh", "A closed surface as an image: 255 where the voxel's centre is inside, else 0.");
  op.source("vtkPolyDataToImageStencil, vtkFillHolesFilter");
  op.note(
      "Exactly one of resolution, isotropicVoxelSize and referenceCoordinateGrid is given; 0 means not given. "
      "Without a reference grid one empty layer of voxels is added on all sides, so that the image of an object "
      "never touches the border.");
  op.note("MSML voxelizes an open surface without a word; here it is an error unless its holes can be filled.");
  const auto surface = op.input<Surface>("surfaceMesh", "closed, or with holes that may be filled");
  const auto resolution = op.parameter<Integer>(
      "resolution", {.unit = "voxels",
                     .range = closed(0, 4096),
                     .fallback = 0,
                     .doc = "cubic voxels along the longest side of the surface, margins included; 0 = not given"});
  const auto voxel_size = op.parameter(
      "isotropicVoxelSize",
      {.unit = "length", .range = nonnegative(), .fallback = 0.0, .doc = "edge of the cubic voxels; 0 = not given"});
  const auto reference =
      op.input<Image>("referenceCoordinateGrid", "an image whose grid is taken; its values mean nothing", true);
  const auto no_filling = op.parameter<bool>(
      "disableFillHoles",
      {.fallback = false, .doc = "true: a surface with holes is an error instead of being repaired"});
  const auto margin =
      op.parameter("additionalIsotropicMargin", {.unit = "length",
                                                 .range = nonnegative(),
                                                 .fallback = 0.0,
                                                 .doc = "added to the bounding box on all sides; has no "
                                                        "effect with a reference grid"});
  const auto image = op.output<Image>("image", "uint8, 0 and 255");
  op.target("targetImageFilename", image, "file to write the image to");
  const auto check = [=](const Record& r) {
    if (!r.has(resolution) || !r.has(voxel_size)) return;
    const int given = (r[resolution] > 0) + (r[voxel_size] > 0) + r.is_given(reference);
    if (given != 1)
      throw Error(
          fmt::format("{} of resolution, isotropicVoxelSize and referenceCoordinateGrid are given; exactly one "
                      "is needed",
                      given));
  };
  run_checked(op, check, [=](Context& c) {
    const Surface whole = closed_surface(c.get(surface), !c.get(no_filling), c.reporter());
    if (c.has(reference)) return c.set(image, filled(whole, c.get(reference)));
    const double voxel = c.get(voxel_size) > 0
                             ? c.get(voxel_size)
                             : (longest_side(whole) + 2 * c.get(margin)) / static_cast<double>(c.get(resolution));
    c.set(image, filled(whole, grid_around(whole, voxel, c.get(margin))));
  });
  return op;
}

}  // namespace msml::operators
