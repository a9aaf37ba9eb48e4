// SPDX-License-Identifier: GPL-3.0-or-later
// Inrimage files, plain or gzipped: a header of a multiple of 256 bytes that ends in "##}", then the voxels.
// CGAL_ImageIO also reads them, but it prints its complaints and keeps unguarded process-wide lists.
#include <fmt/format.h>

#include <map>

#include "operators/formats/formats.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

constexpr std::string_view magic = "#INRIMAGE-4#{", closing = "##}\n";
using Keys = std::map<std::string, std::string, std::less<>>;

Keys keys_of(std::string_view header) {
  Keys keys;
  for (std::size_t at = magic.size(); at < header.size();) {
    const std::size_t end = std::min(header.find('\n', at), header.size());
    const std::string_view line = header.substr(at, end - at);
    const std::size_t equals = line.find('=');
    if (!line.starts_with('#') && equals != std::string_view::npos)
      keys[std::string(line.substr(0, equals))] = std::string(line.substr(equals + 1));
    at = end + 1;
  }
  return keys;
}

double number(const Keys& keys, const char* key, double fallback) {
  const auto found = keys.find(key);
  return found == keys.end() ? fallback : Scanner(found->second).number();
}

int whole(const Keys& keys, const char* key, int fallback) {
  const auto found = keys.find(key);
  if (found == keys.end()) return fallback;
  const long long value = Scanner(found->second).integer();
  if (value < 1 || value > 1 << 30) throw Error(fmt::format("{} = {} is not possible", key, value));
  return static_cast<int>(value);
}

Stored stored_of(const Keys& keys) {
  const int bits = whole(keys, "PIXSIZE", 8);
  const auto type = keys.find("TYPE");
  const std::string words = type == keys.end() ? "unsigned fixed" : type->second;
  const std::map<std::string, Stored> known{{"unsigned fixed 8", Stored::uint8},
                                            {"signed fixed 8", Stored::int8},
                                            {"unsigned fixed 16", Stored::uint16},
                                            {"signed fixed 16", Stored::int16},
                                            {"unsigned fixed 32", Stored::uint32},
                                            {"signed fixed 32", Stored::int32},
                                            {"unsigned fixed 64", Stored::uint64},
                                            {"signed fixed 64", Stored::int64},
                                            {"float 32", Stored::float32},
                                            {"float 64", Stored::float64},
                                            {"fixed 8", Stored::uint8},
                                            {"fixed 16", Stored::uint16}};
  const auto found = known.find(fmt::format("{} {}", words.substr(0, words.find_last_not_of(" \r") + 1), bits));
  if (found == known.end()) throw Error(fmt::format("TYPE={} with PIXSIZE={} bits cannot be read", words, bits));
  return found->second;
}

Image parse(std::string bytes) {
  constexpr std::size_t most = std::size_t{1} << 36;
  if (bytes.starts_with("\x1f\x8b")) bytes = inflated_up_to(bytes, most);
  if (!bytes.starts_with(magic)) throw Error("is no Inrimage file: it does not begin with " + std::string(magic));
  const std::size_t end = bytes.find(closing);
  if (end == std::string::npos) throw Error("has no end of header; it may be cut off");
  const Keys keys = keys_of(std::string_view(bytes).substr(0, end));
  Image image;
  image.size = {whole(keys, "XDIM", 1), whole(keys, "YDIM", 1), whole(keys, "ZDIM", 1)};
  image.components = whole(keys, "VDIM", 1);
  image.spacing = {number(keys, "VX", 1), number(keys, "VY", 1), number(keys, "VZ", 1)};
  image.origin = {number(keys, "TX", 0), number(keys, "TY", 0), number(keys, "TZ", 0)};
  const auto cpu = keys.find("CPU");
  const bool big = cpu != keys.end() && (cpu->second.starts_with("sun") || cpu->second.starts_with("sgi"));
  image.voxels = decode(std::string_view(bytes).substr(end + closing.size()), stored_of(keys), big,
                        value_count(image.size, image.components));
  image.check();
  return image;
}

std::string written(const Image& image) {
  image.check();
  require_upright(image);
  constexpr std::array<const char*, 10> types{"signed fixed", "unsigned fixed", "signed fixed", "unsigned fixed",
                                              "signed fixed", "unsigned fixed", "signed fixed", "unsigned fixed",
                                              "float",        "float"};
  const Stored stored = stored_as(image.voxels);
  std::string header = fmt::format(
      "{}\nXDIM={}\nYDIM={}\nZDIM={}\nVDIM={}\nTYPE={}\nPIXSIZE={} "
      "bits\n{}CPU=decm\nVX={}\nVY={}\nVZ={}\nTX={}\nTY={}\n"
      "TZ={}\n",
      magic, image.size[0], image.size[1], image.size[2], image.components, types[static_cast<std::size_t>(stored)],
      8 * size_of(stored), stored < Stored::float32 ? "SCALE=2**0\n" : "", image.spacing[0], image.spacing[1],
      image.spacing[2], image.origin[0], image.origin[1], image.origin[2]);
  constexpr std::size_t block = 256;
  const std::size_t blocks = (header.size() + closing.size() + block - 1) / block;
  header.append(blocks * block - header.size() - closing.size(), '\n');
  return header.append(closing) + encode(image.voxels);
}

}  // namespace

Format inrimage() {
  return {
      .extensions = {".inr", ".inr.gz"},
      .doc = "Inrimage, plain or gzipped; spacing VX VY VZ, origin TX TY TZ.",
      .reads = {Type::image},
      .writes = {Type::image},
      .read = [](const auto& path,
                 Type) { return reading(path, [&] { return std::make_shared<const Image>(parse(text_of(path))); }); },
      .write =
          [](const Value& value, const auto& path, const std::string& extension) {
            writing(path, [&] {
              const std::string bytes = written(*std::get<ImagePtr>(value));
              put(path, extension == ".inr.gz" ? deflated(bytes) : bytes);
            });
          }};
}

}  // namespace msml::operators
