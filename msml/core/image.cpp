// SPDX-License-Identifier: GPL-3.0-or-later
// Access to voxels, and the checks of an image.
#include "msml/core/image.hpp"

#include <fmt/format.h>

#include <cmath>

#include "msml/core/error.hpp"

namespace msml {

std::size_t Image::voxel_count() const {
  return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
}

std::size_t Image::index(int i, int j, int k) const {
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
  return (static_cast<std::size_t>(k) * ny + static_cast<std::size_t>(j)) * nx + static_cast<std::size_t>(i);
}

double Image::at(std::size_t voxel, int component) const {
  const std::size_t i = voxel * static_cast<std::size_t>(components) + static_cast<std::size_t>(component);
  return std::visit([i](const auto& values) { return static_cast<double>(values[i]); }, voxels);
}

std::string Image::summary() const {
  constexpr std::array<const char*, 6> types{"uint8", "int16", "uint16", "int32", "float", "double"};
  std::string text = fmt::format("{} x {} x {} {}", size[0], size[1], size[2], types[voxels.index()]);
  if (components > 1) text += fmt::format(" x {}", components);
  return text;
}

void Image::check() const {
  if (size[0] < 1 || size[1] < 1 || size[2] < 1)
    throw Error(fmt::format("image of {} x {} x {} voxels is empty", size[0], size[1], size[2]));
  if (!(spacing.array() > 0).all() || !spacing.allFinite() || !origin.allFinite())
    throw Error(fmt::format("image spacing ({} {} {}) is not > 0 or its origin is not finite", spacing[0], spacing[1],
                            spacing[2]));
  std::visit(
      [this](const auto& values) {
        if (values.size() != voxel_count() * static_cast<std::size_t>(components))
          throw Error(fmt::format("image has {} values for {} voxels of {} components", values.size(), voxel_count(),
                                  components));
        for (std::size_t i = 0; i < values.size(); ++i)
          if (!std::isfinite(static_cast<double>(values[i])))
            throw Error(fmt::format("image value {} is not finite", i));
      },
      voxels);
}

}  // namespace msml
