// SPDX-License-Identifier: GPL-3.0-or-later
// Voxel values to and from bytes; zlib.
#include "operators/formats/raw_voxels.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
static_assert(std::endian::native == std::endian::little);

/// Numbers stored as From, kept as To.
template <class From, class To = From>
std::vector<To> numbers(std::string_view bytes, bool swap, std::size_t count) {
  std::vector<To> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, sizeof(From)> raw;
    std::memcpy(raw.data(), bytes.data() + i * sizeof(From), sizeof(From));
    if (swap) std::reverse(raw.begin(), raw.end());
    values[i] = static_cast<To>(std::bit_cast<From>(raw));
  }
  return values;
}

Voxels narrowed(std::vector<double> values) {
  constexpr double low = std::numeric_limits<std::int32_t>::min(), high = std::numeric_limits<std::int32_t>::max();
  if (!std::all_of(values.begin(), values.end(), [](double v) { return v >= low && v <= high; })) return values;
  return std::vector<std::int32_t>(values.begin(), values.end());
}

struct Inflater {
  z_stream stream{};
  Inflater() {
    if (inflateInit2(&stream, 15 + 32) != Z_OK) throw Error("zlib cannot start");  // 32: zlib and gzip alike
  }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

std::size_t size_of(Stored stored) { return sizes[static_cast<std::size_t>(stored)]; }

Voxels decode(std::string_view bytes, Stored stored, bool big_endian, std::size_t count) {
  if (bytes.size() != count * size_of(stored))
    throw Error(
        fmt::format("holds {} bytes of voxels where its header says {}", bytes.size(), count * size_of(stored)));
  switch (stored) {
    case Stored::int8:
      return numbers<std::int8_t, std::int16_t>(bytes, big_endian, count);
    case Stored::uint8:
      return numbers<std::uint8_t>(bytes, big_endian, count);
    case Stored::int16:
      return numbers<std::int16_t>(bytes, big_endian, count);
    case Stored::uint16:
      return numbers<std::uint16_t>(bytes, big_endian, count);
    case Stored::int32:
      return numbers<std::int32_t>(bytes, big_endian, count);
    case Stored::float32:
      return numbers<float>(bytes, big_endian, count);
    case Stored::float64:
      return numbers<double>(bytes, big_endian, count);
    case Stored::uint32:
      return narrowed(numbers<std::uint32_t, double>(bytes, big_endian, count));
    case Stored::int64:
      return narrowed(numbers<std::int64_t, double>(bytes, big_endian, count));
    case Stored::uint64:
      return narrowed(numbers<std::uint64_t, double>(bytes, big_endian, count));
  }
  throw Error("unknown voxel type", {}, Failure::internal);
}

std::string encode(const Voxels& voxels) {
  return std::visit(
      [](const auto& values) {
        return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
      },
      voxels);
}

Stored stored_as(const Voxels& voxels) {
  constexpr std::array<Stored, 6> kinds{Stored::uint8, Stored::int16,   Stored::uint16,
                                        Stored::int32, Stored::float32, Stored::float64};
  return kinds[voxels.index()];
}

std::size_t value_count(const std::array<int, 3>& size, int components) {
  constexpr double most = 1099511627776.0;  // 2^40
  const double product = 1.0 * size[0] * size[1] * size[2] * components;
  if (std::min({size[0], size[1], size[2], components}) < 1 || product > most)
    throw Error(fmt::format("an image of {} x {} x {} voxels of {} components is not possible", size[0], size[1],
                            size[2], components));
  return static_cast<std::size_t>(product);
}

std::string inflated_up_to(std::string_view packed, std::size_t most) {
  Inflater inflater;
  z_stream& z = inflater.stream;
  std::string out;
  std::size_t used = 0;
  constexpr std::size_t chunk = std::size_t{1} << 20;
  int code = Z_OK;
  while (code != Z_STREAM_END) {
    if (z.avail_in == 0) {
      z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
      z.avail_in = static_cast<uInt>(std::min(chunk, packed.size() - used));
      used += z.avail_in;
    }
    const std::size_t filled = out.size();
    out.resize(filled + chunk);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + filled);
    z.avail_out = chunk;
    const bool starved = z.avail_in == 0;
    code = inflate(&z, Z_NO_FLUSH);
    out.resize(filled + chunk - z.avail_out);
    if (starved && code == Z_BUF_ERROR) throw Error("the compressed data is cut off");
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) throw Error("the compressed data is broken");
    if (out.size() > most) throw Error(fmt::format("the compressed data unpacks to more than {} bytes", most));
  }
  return out;
}

std::string inflated(std::string_view packed, std::size_t size) {
  std::string out = inflated_up_to(packed, size);
  if (out.size() != size)
    throw Error(fmt::format("the compressed data unpacks to {} bytes where the header says {}", out.size(), size));
  return out;
}

std::string deflated(std::string_view bytes) {
  z_stream z{};
  if (deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib cannot start");
  std::string out;
  constexpr std::size_t chunk = std::size_t{1} << 20;
  std::size_t used = 0;
  int code = Z_OK;
  while (code != Z_STREAM_END) {
    if (z.avail_in == 0 && used < bytes.size()) {
      z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + used));
      z.avail_in = static_cast<uInt>(std::min(chunk, bytes.size() - used));
      used += z.avail_in;
    }
    const std::size_t filled = out.size();
    out.resize(filled + chunk);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + filled);
    z.avail_out = chunk;
    code = deflate(&z, used == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    out.resize(filled + chunk - z.avail_out);
  }
  deflateEnd(&z);
  return out;
}

}  // namespace msml::operators
