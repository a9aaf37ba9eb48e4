// SPDX-License-Identifier: GPL-3.0-or-later
// MetaImage .mha: lines "Key = value", the last of which is "ElementDataFile = LOCAL", then the voxels. VTK's reader
// drops the direction and prints its complaints, so this one is its own.
#include <fmt/format.h>

#include <map>

#include "operators/formats/formats.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

const std::map<std::string, Stored, std::less<>>& types() {
  static const std::map<std::string, Stored, std::less<>> known{
      {"MET_CHAR", Stored::int8},       {"MET_UCHAR", Stored::uint8},       {"MET_SHORT", Stored::int16},
      {"MET_USHORT", Stored::uint16},   {"MET_INT", Stored::int32},         {"MET_UINT", Stored::uint32},
      {"MET_LONG_LONG", Stored::int64}, {"MET_ULONG_LONG", Stored::uint64}, {"MET_FLOAT", Stored::float32},
      {"MET_DOUBLE", Stored::float64}};
  return known;
}

using Keys = std::map<std::string, std::string, std::less<>>;

/// Reads the header lines; `data` becomes the position behind them.
Keys keys_of(std::string_view bytes, std::size_t& data) {
  Keys keys;
  constexpr std::size_t longest = 1 << 16;
  for (std::size_t at = 0; at < std::min(bytes.size(), longest);) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    const std::string_view line = bytes.substr(at, end - at);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) break;
    const std::string key = trimmed(line.substr(0, equals));
    keys[key] = trimmed(line.substr(equals + 1));
    at = data = end + 1;
    if (key == "ElementDataFile") return keys;
  }
  throw Error("is no MetaImage file, or is cut off: its header does not end in ElementDataFile");
}

std::string get(const Keys& keys, std::initializer_list<const char*> names, const char* fallback) {
  for (const char* const name : names)
    if (const auto found = keys.find(name); found != keys.end()) return found->second;
  return fallback;
}

bool flag(const Keys& keys, std::initializer_list<const char*> names) {
  const std::string text = get(keys, names, "False");
  return text == "True" || text == "true" || text == "1";
}

Vec3 vec(const std::string& text) {
  Scanner in(text);
  const double x = in.number(), y = in.number();
  return {x, y, in.number()};
}

Mat3 mat(const std::string& text) {
  Scanner in(text);
  Mat3 direction;
  for (int axis = 0; axis < 3; ++axis)  // each axis of the image is three numbers in a row: a column of the matrix
    for (int i = 0; i < 3; ++i) direction(i, axis) = in.number();
  return direction;
}

Image parse(const std::string& bytes) {
  std::size_t data = 0;
  const Keys keys = keys_of(bytes, data);
  if (get(keys, {"NDims"}, "") != "3") throw Error("has NDims = " + get(keys, {"NDims"}, "nothing") + ", not 3");
  if (get(keys, {"ElementDataFile"}, "") != "LOCAL")
    throw Error("keeps its voxels in another file, " + get(keys, {"ElementDataFile"}, "") + "; only LOCAL can be read");
  Image image;
  const std::string dim_size = keys.count("DimSize") ? keys.at("DimSize") : "";
  Scanner sizes(dim_size);
  for (int& size : image.size) size = static_cast<int>(std::clamp(sizes.integer(), 0LL, 1LL << 30));
  const std::string channels = get(keys, {"ElementNumberOfChannels"}, "1");
  image.components = static_cast<int>(Scanner(channels).integer());
  image.spacing = vec(get(keys, {"ElementSpacing", "ElementSize"}, "1 1 1"));
  image.origin = vec(get(keys, {"Offset", "Position", "Origin"}, "0 0 0"));
  image.direction = mat(get(keys, {"TransformMatrix", "Rotation", "Orientation"}, "1 0 0 0 1 0 0 0 1"));
  const auto type = types().find(get(keys, {"ElementType"}, ""));
  if (type == types().end()) throw Error("has ElementType = " + get(keys, {"ElementType"}, "nothing"));
  const std::size_t count = value_count(image.size, image.components);
  const std::string_view stored = std::string_view(bytes).substr(data);
  const bool big = flag(keys, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"});
  image.voxels = flag(keys, {"CompressedData"})
                     ? decode(inflated(stored, count * size_of(type->second)), type->second, big, count)
                     : decode(stored, type->second, big, count);
  image.check();
  return image;
}

std::string written(const Image& image) {
  image.check();
  std::string type;
  for (const auto& [name, stored] : types())
    if (stored == stored_as(image.voxels)) type = name;
  const Mat3& d = image.direction;
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = "
             "False\n"
             "TransformMatrix = {} {} {} {} {} {} {} {} {}\nOffset = {} {} {}\nElementSpacing = {} {} {}\n"
             "DimSize = {} {} {}\nElementNumberOfChannels = {}\nElementType = {}\nElementDataFile = LOCAL\n",
             d(0, 0), d(1, 0), d(2, 0), d(0, 1), d(1, 1), d(2, 1), d(0, 2), d(1, 2), d(2, 2), image.origin[0],
             image.origin[1], image.origin[2], image.spacing[0], image.spacing[1], image.spacing[2], image.size[0],
             image.size[1], image.size[2], image.components, type) +
         encode(image.voxels);
}

}  // namespace

Format meta_image() {
  return image_text_format(
      ".mha", "MetaImage with the voxels in the same file, plain or compressed; written plain, with direction.", parse,
      written);
}

}  // namespace msml::operators
