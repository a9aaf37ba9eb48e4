// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateEmptyImage3D: a grid of zeros.
#include "msml/core/operator.hpp"
#include "operators/formats/raw_voxels.hpp"

namespace msml::operators {

Operator generate_empty_image();

namespace {

Vec3 vec(const std::vector<double>& list) { return {list[0], list[1], list[2]}; }

Image zeros(const std::vector<Integer>& dim, const Vec3& origin, const Vec3& spacing) {
  const std::array<int, 3> size{static_cast<int>(dim[0]), static_cast<int>(dim[1]), static_cast<int>(dim[2])};
  value_count(size, 1);  // refuses what cannot be
  return make_image<double>(size, origin, spacing);
}

}  // namespace

Operator generate_empty_image() {
  Operator op("GenerateEmptyImage3D", "An image of zeros (double), as a grid for other operators to work on.");
  const auto dim = op.parameter<std::vector<Integer>>(
      "dim", {.unit = "voxels", .range = closed(1, 65536), .counts = {3}, .doc = "voxels along x, y and z"});
  const auto spacing = op.parameter<std::vector<double>>(
      "spacing", {.unit = "length",
                  .range = positive(),
                  .fallback = std::vector<double>{1, 1, 1},
                  .counts = {3},
                  .doc = "distance between the centres of neighbours along x, y and z"});
  const auto origin = op.parameter<std::vector<double>>(
      "origin",
      {.unit = "length", .fallback = std::vector<double>{0, 0, 0}, .counts = {3}, .doc = "centre of the first voxel"});
  const auto image = op.output<Image>("image", "dim voxels of the value 0");
  op.target("targetImageFilename", image, "file to write the image to");
  op.run([=](Context& c) { c.set(image, zeros(c.get(dim), vec(c.get(origin)), vec(c.get(spacing)))); });
  return op;
}

}  // namespace msml::operators
