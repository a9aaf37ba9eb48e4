// SPDX-License-Identifier: GPL-3.0-or-later
// Voxel values to and from bytes, for the formats whose header is a text.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "msml/core/image.hpp"

namespace msml::operators {

/// How a number is stored in a file.
enum class Stored : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
std::size_t size_of(Stored stored);  ///< bytes of one number

/// The numbers in `bytes`, in the narrowest type of Voxels that holds all of their type (int64 and uint32 as double
/// where a value needs it). Throws Error unless there are exactly `count` of them.
Voxels decode(std::string_view bytes, Stored stored, bool big_endian, std::size_t count);

/// The values as little-endian bytes, and how they are stored.
std::string encode(const Voxels& voxels);
Stored stored_as(const Voxels& voxels);

/// size x * y * z * components; throws Error where one is below 1 or the product exceeds 2^40.
std::size_t value_count(const std::array<int, 3>& size, int components);

/// Inflates zlib or gzip data of `size` bytes. Throws Error where the data is broken or has another length.
std::string inflated(std::string_view packed, std::size_t size);
/// Inflates all of it, whatever its length, up to `most` bytes.
std::string inflated_up_to(std::string_view packed, std::size_t most);
/// gzip data.
std::string deflated(std::string_view bytes);

}  // namespace msml::operators
