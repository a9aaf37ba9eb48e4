// SPDX-License-Identifier: GPL-3.0-or-later
// Reads PLY polygons (G. Turk, "The PLY Polygon File Format", 1994).
#include "operators/formats/ply_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "msml/core/error.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

enum class Coding { ascii, little, big };

struct Property {
  std::string name;
  Stored type = Stored::float32;
  std::optional<Stored> length;  ///< of a list: how its length is stored
};

struct Element {
  std::string name;
  int count = 0;
  std::vector<Property> properties;
};

Stored type_of_word(std::string_view word) {
  const std::map<std::string_view, Stored> types{
      {"char", Stored::int8},      {"int8", Stored::int8},       {"uchar", Stored::uint8},
      {"uint8", Stored::uint8},    {"short", Stored::int16},     {"int16", Stored::int16},
      {"ushort", Stored::uint16},  {"uint16", Stored::uint16},   {"int", Stored::int32},
      {"int32", Stored::int32},    {"uint", Stored::uint32},     {"uint32", Stored::uint32},
      {"float", Stored::float32},  {"float32", Stored::float32}, {"double", Stored::float64},
      {"float64", Stored::float64}};
  const auto found = types.find(word);
  if (found == types.end()) throw Error(fmt::format("property type '{}' cannot be read", word.substr(0, 40)));
  return found->second;
}

Coding coding_of(std::string_view word) {
  if (word == "ascii") return Coding::ascii;
  if (word == "binary_little_endian") return Coding::little;
  if (word == "binary_big_endian") return Coding::big;
  throw Error(fmt::format("format '{}' cannot be read", word.substr(0, 40)));
}

Property property_of(Scanner& line) {
  Property property;
  std::string_view word = line.word();
  if (word == "list") {
    property.length = type_of_word(line.word());
    word = line.word();
  }
  property.type = type_of_word(word);
  property.name = std::string(line.word());
  return property;
}

/// The elements that the header announces; the cursor is left behind it.
std::vector<Element> read_header(Scanner& in, Coding& coding) {
  std::vector<Element> elements;
  if (!in.line().starts_with("ply")) throw Error("is no PLY file: it does not begin with ply");
  while (!in.at_end()) {
    Scanner line(in.line());
    if (line.at_end()) continue;
    const std::string_view key = line.word();
    if (key == "end_header") return elements;
    if (key == "format")
      coding = coding_of(line.word());
    else if (key == "element") {
      const std::string name(line.word());
      const long long count = line.integer();
      if (count < 0 || count > 1LL << 30) throw Error(fmt::format("{} elements {} are not possible", count, name));
      elements.push_back({.name = name, .count = static_cast<int>(count)});
    } else if (key == "property" && !elements.empty())
      elements.back().properties.push_back(property_of(line));
    else if (key != "comment" && key != "obj_info")
      throw Error(fmt::format("line '{}' of the header cannot be read", key.substr(0, 40)));
  }
  throw Error("is cut off: its header has no end");
}

/// One number of the body.
double number(Scanner& in, Coding coding, Stored stored) {
  if (coding == Coding::ascii) return in.number();
  const Voxels value = decode(in.raw(size_of(stored)), stored, coding == Coding::big, 1);
  return std::visit([](const auto& values) { return static_cast<double>(values[0]); }, value);
}

std::vector<double> numbers(Scanner& in, Coding coding, const Property& property) {
  double length = 1;
  if (property.length) length = number(in, coding, *property.length);
  constexpr double longest = 1 << 20;
  if (!(length >= 0 && length <= longest)) throw Error(fmt::format("a list of {} numbers is not possible", length));
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(length); ++i) values.push_back(number(in, coding, property.type));
  return values;
}

void read_element(Scanner& in, Coding coding, const Element& element, PlyPolygons& result) {
  const std::map<std::string, int> axes{{"x", 0}, {"y", 1}, {"z", 2}};
  for (int i = 0; i < element.count; ++i) {
    Vec3 point = Vec3::Zero();
    for (const Property& property : element.properties) {
      const std::vector<double> values = numbers(in, coding, property);
      if (const auto axis = axes.find(property.name); axis != axes.end() && !property.length)
        point[axis->second] = values[0];
      if (element.name == "face" && property.length && property.name.starts_with("vertex_ind"))
        result.faces.emplace_back(values.begin(), values.end());
    }
    if (element.name == "vertex") result.points.push_back(point);
  }
}

}  // namespace

PlyPolygons read_ply(const std::string& file) {
  Scanner in(file);
  Coding coding = Coding::ascii;
  PlyPolygons result;
  for (const Element& element : read_header(in, coding)) {
    if (element.properties.empty() && element.count > 0)
      throw Error(fmt::format("element {} has no properties", element.name));
    read_element(in, coding, element, result);
  }
  return result;
}

}  // namespace msml::operators
