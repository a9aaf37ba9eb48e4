// SPDX-License-Identifier: GPL-3.0-or-later
// NRRD with attached data: a magic word, lines "field: value", an empty line, the voxels (teem.sourceforge.net/nrrd,
// "Definition of NRRD File Format"). VTK's reader drops the direction, so this one is its own.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "operators/formats/formats.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

using Keys = std::map<std::string, std::string, std::less<>>;

const std::map<std::string, Stored, std::less<>>& types() {
  static const std::map<std::string, Stored, std::less<>> known = [] {
    std::map<std::string, Stored, std::less<>> all;
    const auto add = [&](Stored stored, std::initializer_list<const char*> names) {
      for (const char* const name : names) all[name] = stored;
    };
    add(Stored::int8, {"signed char", "int8", "int8_t"});
    add(Stored::uint8, {"uchar", "unsigned char", "uint8", "uint8_t"});
    add(Stored::int16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
    add(Stored::uint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
    add(Stored::int32, {"int", "signed int", "int32", "int32_t"});
    add(Stored::uint32, {"uint", "unsigned int", "uint32", "uint32_t"});
    add(Stored::int64, {"longlong", "long long", "long long int", "signed long long", "int64", "int64_t"});
    add(Stored::uint64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
    add(Stored::float32, {"float"});
    add(Stored::float64, {"double"});
    return all;
  }();
  return known;
}

Keys keys_of(std::string_view bytes, std::size_t& data) {
  if (!bytes.starts_with("NRRD000")) throw Error("is no NRRD file: it does not begin with NRRD000");
  Keys keys;
  for (std::size_t at = bytes.find('\n') + 1; at > 0 && at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    const std::string line = trimmed(bytes.substr(at, end - at));
    at = data = end + 1;
    if (line.empty()) return keys;
    const std::size_t colon = line.find(": ");
    if (line.front() != '#' && colon != std::string::npos)
      keys[line.substr(0, colon)] = trimmed(line.substr(colon + 1));
  }
  throw Error("is cut off: its header has no end");
}

std::string get(const Keys& keys, const char* key, const char* fallback) {
  const auto found = keys.find(key);
  return found == keys.end() ? fallback : found->second;
}

/// The numbers of a text such as "none (1,0,0) (0,1,0) (0,0,2)".
std::vector<double> numbers(std::string text) {
  std::vector<double> values;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  for (Scanner in(text); !in.at_end();) {
    const std::string word(in.word());
    if (word != "none" && word != "nan" && word != "NaN") values.push_back(Scanner(word).number());
  }
  return values;
}

/// Spacing and direction from the vectors between voxels, or from the plain spacings.
void place(const Keys& keys, Image& image) {
  const std::vector<double> origin = numbers(get(keys, "space origin", "(0,0,0)"));
  const std::vector<double> axes = numbers(get(keys, "space directions", ""));
  const std::vector<double> spacings = numbers(get(keys, "spacings", ""));
  if (origin.size() == 3) image.origin = {origin[0], origin[1], origin[2]};
  if (axes.size() == 9) {
    for (int a = 0; a < 3; ++a) {
      const Vec3 axis(axes[static_cast<std::size_t>(3 * a)], axes[static_cast<std::size_t>(3 * a + 1)],
                      axes[static_cast<std::size_t>(3 * a + 2)]);
      image.spacing[a] = axis.norm();
      if (!(image.spacing[a] > 0)) throw Error(fmt::format("the space direction of axis {} has no length", a));
      image.direction.col(a) = axis / image.spacing[a];
    }
  } else if (!axes.empty()) {
    throw Error(fmt::format("has {} numbers in its space directions, not 9", axes.size()));
  } else if (spacings.size() == 3) {
    image.spacing = {spacings[0], spacings[1], spacings[2]};
  }
}

Voxels voxels_of(const Keys& keys, std::string_view stored, std::size_t count) {
  const auto type = types().find(get(keys, "type", ""));
  if (type == types().end()) throw Error("has type: " + get(keys, "type", "nothing") + ", which cannot be read");
  const std::string encoding = get(keys, "encoding", "nothing");
  const bool big = get(keys, "endian", "little") == "big";
  if (encoding == "raw") return decode(stored, type->second, big, count);
  if (encoding == "gzip" || encoding == "gz")
    return decode(inflated(stored, count * size_of(type->second)), type->second, big, count);
  throw Error("has encoding: " + encoding + "; only raw and gzip can be read");
}

Image parse(const std::string& bytes) {
  std::size_t data = 0;
  const Keys keys = keys_of(bytes, data);
  if (keys.count("data file") || keys.count("datafile")) throw Error("keeps its voxels in another file");
  const std::string line = keys.count("sizes") ? keys.at("sizes") : "";
  Scanner in(line);
  std::vector<int> sizes;
  while (!in.at_end()) sizes.push_back(static_cast<int>(std::clamp(in.integer(), 0LL, 1LL << 30)));
  if (sizes.size() != 3 && sizes.size() != 4)
    throw Error(fmt::format("has {} dimensions, not 3, or 4 with components first", sizes.size()));
  Image image;
  if (sizes.size() == 4) {
    image.components = sizes.front();
    sizes.erase(sizes.begin());
  }
  std::copy(sizes.begin(), sizes.end(), image.size.begin());
  place(keys, image);
  image.voxels = voxels_of(keys, std::string_view(bytes).substr(data), value_count(image.size, image.components));
  image.check();
  return image;
}

std::string written(const Image& image) {
  image.check();
  constexpr std::array<const char*, 10> names{"int8",   "uint8", "int16",  "uint16", "int32",
                                              "uint32", "int64", "uint64", "float",  "double"};
  const bool vectors = image.components > 1;
  const Mat3 axes = image.direction * image.spacing.asDiagonal();
  const auto vec = [](const auto& v) { return fmt::format("({},{},{})", v[0], v[1], v[2]); };
  return fmt::format(
             "NRRD0005\ntype: {}\ndimension: {}\nspace dimension: 3\nsizes: {}{} {} {}\nspace directions: {}{} {} {}\n"
             "kinds: {}domain domain domain\nendian: little\nencoding: raw\nspace origin: {}\n\n",
             names[static_cast<std::size_t>(stored_as(image.voxels))], vectors ? 4 : 3,
             vectors ? fmt::format("{} ", image.components) : "", image.size[0], image.size[1], image.size[2],
             vectors ? "none " : "", vec(axes.col(0)), vec(axes.col(1)), vec(axes.col(2)), vectors ? "list " : "",
             vec(image.origin)) +
         encode(image.voxels);
}

}  // namespace

Format nrrd() {
  return image_text_format(
      ".nrrd", "NRRD with attached data, raw or gzip; written raw, with direction. Coordinates are the file's own.",
      parse, written);
}

}  // namespace msml::operators
