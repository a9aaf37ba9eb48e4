// SPDX-License-Identifier: GPL-3.0-or-later
// A walk over a legacy VTK file, see "VTK File Formats", simple legacy formats.
#include "operators/formats/legacy_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "msml/core/error.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/formats/scanner.hpp"

namespace msml::operators {
namespace {

std::size_t bytes_of(std::string_view type) {
  const std::map<std::string_view, std::size_t> sizes{
      {"unsigned_char", 1}, {"char", 1},          {"unsigned_short", 2}, {"short", 2}, {"unsigned_int", 4},
      {"int", 4},           {"unsigned_long", 8}, {"long", 8},           {"float", 4}, {"double", 8},
      {"vtktypeint64", 8},  {"vtkIdType", 4},     {"vtktypeuint64", 8},  {"bit", 1}};
  const auto found = sizes.find(type);
  if (found == sizes.end()) throw Error(fmt::format("its points are of type '{}'", type.substr(0, 40)));
  return found->second;
}

std::string upper(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

class Walk {
 public:
  Walk(Scanner& in, bool binary) : in_(in), binary_(binary) {}

  void points() {
    const auto numbers = 3 * static_cast<std::size_t>(in_.count());
    values(numbers, in_.word());
  }

  /// "FIELD name arrays", and for each "name components tuples type" and its values.
  void field() {
    in_.word();
    const int arrays = in_.count();
    for (int a = 0; a < arrays; ++a) {
      in_.word();
      const auto components = static_cast<std::size_t>(in_.integer()), tuples = static_cast<std::size_t>(in_.integer());
      values(components * tuples, in_.word());
    }
  }

  /// "METADATA" and lines up to an empty one.
  void metadata() {
    in_.line();
    while (in_.line().find_first_not_of(" \t\r") != std::string_view::npos) {
    }
  }

  /// "DIMENSIONS nx ny nz", "ORIGIN x y z", …
  void three() {
    for (int i = 0; i < 3; ++i) in_.word();
  }

  /// "COLOR_SCALARS name components", one byte for each in binary: the one array whose end VTK does not look for.
  void colors(int tuples) {
    in_.word();
    const auto components = static_cast<std::size_t>(in_.count());
    if (!binary_) return;
    in_.line();
    in_.raw(components * static_cast<std::size_t>(tuples));
  }

  /// "CELLS number size", then `size` integers: for each cell its number of points and their ids.
  void cells(const std::string& section) {
    const long long number = in_.count(), size = in_.count();
    const std::vector<long long> list = integers(static_cast<std::size_t>(size));
    std::size_t at = 0;
    for (long long c = 0; c < number; ++c) {
      const long long points = at < list.size() ? list[at] : -1;
      if (points < 0 || points >= static_cast<long long>(list.size() - at))
        throw Error(
            fmt::format("cell {} of {} in section {} does not fit its size of {} integers", c, number, section, size));
      at += static_cast<std::size_t>(points) + 1;
    }
    if (at != list.size())
      throw Error(fmt::format("the {} cells of section {} take {} integers, not {}", number, section, at, size));
  }

 private:
  void values(std::size_t numbers, std::string_view type) {
    if (binary_) {
      const std::size_t size = bytes_of(type);
      in_.line();
      in_.raw(numbers * size);
    } else {
      for (std::size_t i = 0; i < numbers; ++i) in_.word();
    }
  }

  std::vector<long long> integers(std::size_t size) {
    std::vector<long long> list(size);
    if (!binary_) {
      for (long long& value : list) value = in_.integer();
      return list;
    }
    in_.line();
    const Voxels values = decode(in_.raw(4 * size), Stored::int32, true, size);
    const auto& ints = std::get<std::vector<std::int32_t>>(values);
    list.assign(ints.begin(), ints.end());
    return list;
  }

  Scanner& in_;
  bool binary_;
};

}  // namespace

void check_legacy_cells(std::string_view file) {
  Scanner in(file);
  const std::string_view magic = in.line();
  constexpr std::string_view start = "# vtk DataFile Version ";
  if (!magic.starts_with(start)) throw Error("is no legacy VTK file: it does not begin with '# vtk DataFile Version'");
  const std::string_view version = magic.substr(start.size(), 3);
  if (version.size() < 3 || version[0] < '1' || version[0] > '5' || version[1] != '.' || !std::isdigit(version[2]))
    throw Error(fmt::format("is of version '{}', not between 1.0 and 5.1", version));
  if (version[0] == '5') return;  // offsets and ids are arrays of their own there, checked after reading
  in.line();
  const std::string coding = upper(in.word());
  if (coding != "ASCII" && coding != "BINARY") throw Error("its third line says neither ASCII nor BINARY");
  Walk walk(in, coding == "BINARY");
  const std::set<std::string> lists{"CELLS", "VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"};
  const std::set<std::string> grid{"DIMENSIONS", "SPACING", "ASPECT_RATIO", "ORIGIN"};
  int tuples = -1;
  while (!in.at_end()) {
    const std::string section = upper(in.word());
    if (section == "DATASET")
      in.word();
    else if (grid.count(section))
      walk.three();
    else if (section == "FIELD")
      walk.field();
    else if (section == "METADATA")
      walk.metadata();
    else if (section == "POINTS")
      walk.points();
    else if (lists.count(section))
      walk.cells(section);
    else if (section == "POINT_DATA" || section == "CELL_DATA")
      tuples = in.count();
    else if (section == "COLOR_SCALARS" && tuples >= 0)
      walk.colors(tuples);
    else if (section == "CELL_TYPES" || tuples >= 0)
      return;
    else
      throw Error(fmt::format("line {}: section '{}' cannot be read", in.line_number(), section.substr(0, 40)));
  }
}

}  // namespace msml::operators
