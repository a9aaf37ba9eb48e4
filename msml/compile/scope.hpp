// SPDX-License-Identifier: GPL-3.0-or-later
// The names a scene declares, and the text of attributes with ${…} taken apart.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "msml/core/error.hpp"
#include "msml/core/mesh.hpp"

namespace msml {

struct Variable {
  std::string value, logical;
  Location where;
  bool used = false;
  std::string unit;        ///< of the attributes that it alone fills; "1" for a plain number, "" where they differ
  bool ambiguous = false;  ///< it fills attributes of several units
};

/// What a name stands for. Variables, tasks and scene outputs share one scope.
struct Named {
  enum class Kind { variable, task, output } kind = Kind::variable;
  Location where;
  Variable variable;       ///< variable
  std::vector<int> nodes;  ///< task: its node, or several when it runs once per file; output: its simulation
  int slot = -1;           ///< output: which
};

using Scope = std::map<std::string, Named>;

/// A piece of an attribute's text: plain, or the inside of ${…}.
struct Piece {
  bool reference = false;
  std::string text;  ///< trimmed where it is a reference
};

/// Takes text apart; `problem` is set where a reference is not closed or empty.
std::vector<Piece> pieces(const std::string& text, std::string& problem);

/// "NodeSet", "FaceSet", "ElementSet" -> what a literal list counts; anything else: `fallback`.
Indexed indexed_by(const std::string& logical, Indexed fallback);

/// True if the whole name matches a pattern in which each `*` stands for any text; `star` gets what the first one held.
bool matches(const std::string& pattern, const std::string& name, std::string* star = nullptr);

/// The name under which a file that a task writes is known: "./a.vtk" and "a.vtk" are the same.
std::string same_file(const std::string& file);

/// a2 before a10: digits compare as numbers.
bool natural_less(const std::string& a, const std::string& b);

/// The text with every `*` replaced by `star`.
std::string with_star(std::string text, const std::string& star);

}  // namespace msml
