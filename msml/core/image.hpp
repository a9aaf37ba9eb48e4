// SPDX-License-Identifier: GPL-3.0-or-later
// A regular grid of voxels: labels or grey values, scalar or vector.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml {

/// Voxel values in the type they were stored in; x runs fastest, components innermost.
using Voxels = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                            std::vector<std::int32_t>, std::vector<float>, std::vector<double>>;

/// Centre of voxel (i j k) = origin + direction * (spacing .* (i j k)).
struct Image {
  std::array<int, 3> size{0, 0, 0};   ///< voxels along x, y, z
  Vec3 origin = Vec3::Zero();         ///< centre of voxel (0 0 0)
  Vec3 spacing = Vec3::Ones();        ///< > 0
  Mat3 direction = Mat3::Identity();  ///< orthonormal columns
  int components = 1;
  Voxels voxels;

  std::size_t voxel_count() const;                        ///< size[0] * size[1] * size[2]
  std::size_t index(int i, int j, int k) const;           ///< of a voxel, component 0 of a scalar image
  double at(std::size_t voxel, int component = 0) const;  ///< as a double
  std::string summary() const;                            ///< "120 x 120 x 120 uint8"
  /// Throws Error unless the sizes agree, spacing is positive, and every value is finite.
  void check() const;
};

/// An image of zeros of voxel type T.
template <class T>
Image make_image(std::array<int, 3> size, Vec3 origin = Vec3::Zero(), Vec3 spacing = Vec3::Ones()) {
  Image image{.size = size, .origin = origin, .spacing = spacing};
  image.voxels = std::vector<T>(image.voxel_count());
  return image;
}

}  // namespace msml
