// SPDX-License-Identifier: GPL-3.0-or-later
// ImageSum: voxel by voxel sum or mean of images on one grid.
#include <fmt/format.h>

#include "msml/core/operator.hpp"

namespace msml::operators {

Operator image_sum();

namespace {

void require_same_grid(const Image& first, const Image& other, std::size_t number) {
  constexpr double tolerance = 1e-6;  // of a voxel: headers in single precision still agree
  const auto differ = [&](const char* what, const std::string& mine, const std::string& theirs) {
    throw Error(
        fmt::format("image {} does not lie on the grid of the first image: {} {}, not {}", number, what, theirs, mine));
  };
  const auto text = [](const auto& v) { return fmt::format("({} {} {})", v[0], v[1], v[2]); };
  if (first.size != other.size) differ("size", text(first.size), text(other.size));
  if (first.components != other.components)
    differ("components", std::to_string(first.components), std::to_string(other.components));
  const double voxel = first.spacing.minCoeff();
  if ((first.spacing - other.spacing).norm() > tolerance * voxel)
    differ("spacing", text(first.spacing), text(other.spacing));
  if ((first.origin - other.origin).norm() > tolerance * voxel)
    differ("origin", text(first.origin), text(other.origin));
  if ((first.direction - other.direction).norm() > tolerance)
    throw Error(fmt::format("image {} is turned differently from the first image", number));
}

Image sum_of(const ImageList& images, bool normalize) {
  if (images.empty()) throw Error("there is no image to add");
  const Image& first = *images.front();
  Image sum = first;
  std::vector<double> total(first.voxel_count() * static_cast<std::size_t>(first.components));
  for (std::size_t i = 0; i < images.size(); ++i) {
    require_same_grid(first, *images[i], i + 1);
    std::visit(
        [&](const auto& values) {
          for (std::size_t v = 0; v < total.size(); ++v) total[v] += static_cast<double>(values[v]);
        },
        images[i]->voxels);
  }
  if (normalize)
    for (double& value : total) value /= static_cast<double>(images.size());
  sum.voxels = std::move(total);
  return sum;
}

}  // namespace

Operator image_sum() {
  Operator op("ImageSum", "The sum of images on one grid, voxel by voxel; with normalize their mean.");
  op.note(
      "The result is of type double, so that sums of bytes do not overflow. Images on different grids are an "
      "error.");
  const auto images = op.input<ImageList>("image",
                                          "images of equal size, origin, spacing and direction; a pattern such "
                                          "as part*.vti takes all that match");
  const auto normalize =
      op.parameter<bool>("normalize", {.fallback = false, .doc = "true: divide by the number of images"});
  const auto sum = op.output<Image>("SumImage", "double");
  op.target("targetSumImage", sum, "file to write the sum to");
  op.run([=](Context& c) { c.set(sum, sum_of(c.get(images), c.get(normalize))); });
  return op;
}

}  // namespace msml::operators
