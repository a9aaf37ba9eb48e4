// SPDX-License-Identifier: GPL-3.0-or-later
// Names, conversions and summaries of values.
#include "msml/core/value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msml/core/braces.hpp"
#include "msml/core/error.hpp"

namespace msml {

const char* name(Type type) {
  constexpr std::array<const char*, 18> names{"nothing",
                                              "boolean",
                                              "integer",
                                              "number",
                                              "text",
                                              "list of integers",
                                              "list of numbers",
                                              "list of words",
                                              "number or expression",
                                              "list of numbers or expressions",
                                              "file",
                                              "Mesh",
                                              "Surface",
                                              "Image",
                                              "IndexSet",
                                              "Field",
                                              "Series",
                                              "list of images"};
  return names[static_cast<std::size_t>(type)];
}

std::string with_article(Type type) {
  const std::string words = name(type);
  return (std::string("aeioAEIO").find(words.front()) == std::string::npos ? "a " : "an ") + words;
}

bool is_data(Type type) { return type >= Type::mesh; }

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

std::vector<std::string> list_parts(const std::string& text) {
  const std::string inner = without_braces(text);
  std::vector<std::string> parts;
  std::size_t i = 0;
  while ((i = inner.find_first_not_of(" \t\r\n,", i)) != std::string::npos) {
    const std::size_t end = std::min(inner.find_first_of(" \t\r\n,", i), inner.size());
    parts.push_back(inner.substr(i, end - i));
    i = end;
  }
  return parts;
}

bool converts(Type from, Type to) {
  if (from == to) return true;
  switch (to) {
    case Type::number:
      return from == Type::integer;
    case Type::integers:
      return from == Type::integer;
    case Type::numbers:
      return from == Type::integer || from == Type::number || from == Type::integers;
    case Type::formula:
      return from == Type::integer || from == Type::number;
    case Type::formulas:
      return from == Type::formula || from == Type::numbers || converts(from, Type::numbers);
    case Type::words:
      return from == Type::text;
    case Type::text:
      return from == Type::integer || from == Type::number || from == Type::boolean;
    case Type::mesh:
      return from == Type::surface || from == Type::series || from == Type::file;
    case Type::surface:
    case Type::image:
      return from == Type::file;
    case Type::images:
      return from == Type::image || from == Type::file;
    default:
      return false;
  }
}

namespace {

std::vector<double> numbers(const Value& value) {
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return *list;
  if (const auto* list = std::get_if<std::vector<Integer>>(&value)) return {list->begin(), list->end()};
  if (const auto* whole = std::get_if<Integer>(&value)) return {static_cast<double>(*whole)};
  return {std::get<double>(value)};
}

Formulas formulas(const Value& value) {
  if (const auto* one = std::get_if<Formula>(&value)) return {*one};
  const std::vector<double> list = numbers(value);
  return {list.begin(), list.end()};
}

std::string text(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<Integer>(&value)) return std::to_string(*whole);
  return fmt::format("{}", std::get<double>(value));
}

}  // namespace

Value convert(const Value& value, Type to) {
  const Type from = type(value);
  if (from == to) return value;
  if (!converts(from, to) || from == Type::file)
    throw Error(fmt::format("{} cannot be used as {}", with_article(from), with_article(to)));
  switch (to) {
    case Type::number:
      return static_cast<double>(std::get<Integer>(value));
    case Type::integers:
      return std::vector<Integer>{std::get<Integer>(value)};
    case Type::numbers:
      return numbers(value);
    case Type::formula:
      return Formula(numbers(value).front());
    case Type::formulas:
      return formulas(value);
    case Type::words:
      return list_parts(std::get<std::string>(value));
    case Type::text:
      return text(value);
    case Type::images:
      return ImageList{std::get<ImagePtr>(value)};
    default:
      break;
  }
  if (from == Type::series) {
    const MeshPtr last = std::get<SeriesPtr>(value)->last;
    if (!last) throw Error("the series has no state yet");
    return last;
  }
  return std::make_shared<const Mesh>(to_mesh(*std::get<SurfacePtr>(value)));
}

namespace {

template <class... F>
struct overloaded : F... {
  using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;

template <class T>
std::size_t held(const std::vector<T>& list) {
  return list.size() * sizeof(T);
}
std::size_t held(const std::vector<Field>& fields) {
  std::size_t sum = 0;
  for (const Field& field : fields) sum += held(field.values);
  return sum;
}
std::size_t held(const Points& points) { return static_cast<std::size_t>(points.size()) * sizeof(double); }
std::size_t held(const Mesh& m) {
  return held(m.points) + held(m.kinds) + held(m.offsets) + held(m.nodes) + held(m.regions) + held(m.point_fields) +
         held(m.cell_fields);
}
std::size_t held(const Surface& s) {
  return held(s.points) + held(s.triangles) + held(s.point_fields) + held(s.cell_fields);
}
std::size_t held(const Image& image) {
  return std::visit([](const auto& values) { return held(values); }, image.voxels);
}

}  // namespace

std::string summary(const Value& value) {
  return std::visit(overloaded{[](std::monostate) { return std::string("nothing"); },
                               [](bool flag) { return std::string(flag ? "true" : "false"); },
                               [](Integer whole) { return std::to_string(whole); },
                               [](double number) { return fmt::format("{:.6g}", number); },
                               [](const std::string& words) { return words; },
                               [](const std::vector<Integer>& list) { return fmt::format("{} integers", list.size()); },
                               [](const std::vector<double>& list) { return fmt::format("{} numbers", list.size()); },
                               [](const Words& list) { return fmt::format("{}", fmt::join(list, " ")); },
                               [](const Formula& formula) {
                                 return formula.constant() ? fmt::format("{:.6g}", formula.number) : formula.text;
                               },
                               [](const Formulas& list) { return fmt::format("{} numbers", list.size()); },
                               [](const File& file) { return file.path.filename().string(); },
                               [](const MeshPtr& mesh) { return mesh->summary(); },
                               [](const SurfacePtr& surface) { return surface->summary(); },
                               [](const ImagePtr& image) { return image->summary(); },
                               [](const IndexSetPtr& set) {
                                 return fmt::format("{} {}", with_commas(static_cast<long long>(set->ids.size())),
                                                    name(set->kind));
                               },
                               [](const FieldPtr& field) {
                                 return fmt::format("field {} with {} values", field->name, field->values.size());
                               },
                               [](const SeriesPtr& series) { return fmt::format("{} states", series->files.size()); },
                               [](const ImageList& images) { return fmt::format("{} images", images.size()); }},
                    value);
}

std::size_t bytes(const Value& value) {
  return std::visit(
      overloaded{
          [](const std::string& words) { return words.size(); },
          [](const std::vector<Integer>& list) { return held(list); },
          [](const std::vector<double>& list) { return held(list); }, [](const Formulas& list) { return held(list); },
          [](const MeshPtr& mesh) { return held(*mesh); }, [](const SurfacePtr& surface) { return held(*surface); },
          [](const ImagePtr& image) { return held(*image); }, [](const IndexSetPtr& set) { return held(set->ids); },
          [](const FieldPtr& field) { return held(field->values); },
          [](const SeriesPtr& series) { return series->last ? held(*series->last) : 0; },
          [](const ImageList& images) {
            std::size_t sum = 0;
            for (const ImagePtr& image : images) sum += held(*image);
            return sum;
          },
          [](const auto&) { return std::size_t{0}; }},
      value);
}

}  // namespace msml
