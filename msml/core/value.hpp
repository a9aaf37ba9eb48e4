// SPDX-License-Identifier: GPL-3.0-or-later
// The typed values that flow on the edges of the graph.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "msml/core/image.hpp"
#include "msml/core/mesh.hpp"

namespace msml {

using Integer = std::int64_t;

/// A file that is handed on as it is, without being read.
struct File {
  std::filesystem::path path;
};

/// The states of a simulation on disk, and the last of them in memory.
struct Series {
  std::string pattern;           ///< "disp_*.vtu", relative to the output folder
  std::filesystem::path folder;  ///< the output folder
  std::vector<double> times;     ///< one per file
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const Mesh> last;  ///< points deformed, field "displacement" = x - X
};

/// A number, or an expression in the reference position X, Y, Z and the time t that gives one. Expressions of a
/// compiled scene are checked and fold to a number where they depend on nothing; see msml/core/formula.hpp.
struct Formula {
  std::string text;   ///< the expression; "" for a number
  double number = 0;  ///< without a text
  Formula() = default;
  Formula(double value) : number(value) {}
  explicit Formula(std::string expression) : text(std::move(expression)) {}
  bool constant() const { return text.empty(); }
  bool operator==(const Formula&) const = default;
};
using Formulas = std::vector<Formula>;
using Words = std::vector<std::string>;

using MeshPtr = std::shared_ptr<const Mesh>;
using SurfacePtr = std::shared_ptr<const Surface>;
using ImagePtr = std::shared_ptr<const Image>;
using IndexSetPtr = std::shared_ptr<const IndexSet>;
using FieldPtr = std::shared_ptr<const Field>;
using SeriesPtr = std::shared_ptr<const Series>;
using ImageList = std::vector<ImagePtr>;

/// monostate = no value. Large values are shared, never copied.
using Value =
    std::variant<std::monostate, bool, Integer, double, std::string, std::vector<Integer>, std::vector<double>, Words,
                 Formula, Formulas, File, MeshPtr, SurfacePtr, ImagePtr, IndexSetPtr, FieldPtr, SeriesPtr, ImageList>;

/// One type per alternative of Value, in the same order.
enum class Type : std::uint8_t {
  nothing,
  boolean,
  integer,
  number,
  text,
  integers,
  numbers,
  words,
  formula,
  formulas,
  file,
  mesh,
  surface,
  image,
  index_set,
  field,
  series,
  images
};

/// The alternative of Value that carries a T: large values travel as shared pointers.
template <class T>
struct carried {
  using type = T;
};
template <>
struct carried<Mesh> {
  using type = MeshPtr;
};
template <>
struct carried<Surface> {
  using type = SurfacePtr;
};
template <>
struct carried<Image> {
  using type = ImagePtr;
};
template <>
struct carried<IndexSet> {
  using type = IndexSetPtr;
};
template <>
struct carried<Field> {
  using type = FieldPtr;
};
template <>
struct carried<Series> {
  using type = SeriesPtr;
};
template <class T>
using carried_t = typename carried<T>::type;
template <class T>
constexpr bool is_shared = !std::is_same_v<carried_t<T>, T>;

namespace detail {
template <class T, std::size_t I = 0>
constexpr std::size_t alternative() {
  if constexpr (std::is_same_v<std::variant_alternative_t<I, Value>, T>)
    return I;
  else
    return alternative<T, I + 1>();
}
}  // namespace detail

template <class T>
constexpr Type type_of = static_cast<Type>(detail::alternative<carried_t<T>>());
inline Type type(const Value& value) { return static_cast<Type>(value.index()); }

/// "Mesh", "IndexSet", "number", "list of numbers", …: the words used in messages, help and the schema.
const char* name(Type type);

/// The same with its article: "a Mesh", "an IndexSet".
std::string with_article(Type type);

/// True for the types that a file can hold: mesh, surface, image, images, index_set, field.
bool is_data(Type type);

/// The text without blanks at its ends.
std::string trimmed(std::string_view text);

/// Parts of a list: separated by blanks, commas or both; one pair of surrounding braces is dropped.
std::vector<std::string> list_parts(const std::string& text);

/// True if a value of `from` can be used as `to` without losing anything:
/// integer -> number -> numbers, integers -> numbers, numbers of all kinds -> formula or formulas, text -> words,
/// surface -> mesh, series -> mesh (its last state), image -> images, and anything readable from a file (file -> mesh |
/// surface | image) by its extension.
bool converts(Type from, Type to);

/// Carries out a conversion for which converts() holds, except reading a file. Throws Error where it does not hold.
Value convert(const Value& value, Type to);

/// A short description for progress lines: "41,203 tet4, 9,120 points", "120 x 120 x 120 uint8", "0.3", …
std::string summary(const Value& value);

/// Bytes held by the value (arrays only), for the memory report.
std::size_t bytes(const Value& value);

}  // namespace msml
