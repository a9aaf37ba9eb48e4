// SPDX-License-Identifier: GPL-3.0-or-later
// A scene file as plain structs: every tag and attribute with its place.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "msml/core/error.hpp"

namespace msml {

struct Attribute {
  std::string name, value;
  Location where;
};

struct Element {
  std::string tag;  ///< without a namespace prefix on the root
  Location where;
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  const Attribute* find(const std::string& name) const;  ///< or null
};

struct Document {
  std::string file;              ///< as named on the command line
  std::filesystem::path folder;  ///< of the file: inputs are looked up from here
  Element root;
};

/// Something wrong, or worth saying, at a place of the scene.
struct Fault {
  Location where;
  std::string message;
  std::string str() const { return where.str() + ": " + message; }
};

/// Reads a scene. Faults of the XML itself (truncated, duplicate attributes, stray text, entity declarations, not
/// UTF-8, larger than 64 MiB) are added to `faults`; the root is then empty or partial.
Document read_document(const std::filesystem::path& path, std::vector<Fault>& faults);

/// The same from text; `file` is the name used in messages.
Document parse_document(const std::string& text, const std::string& file, std::vector<Fault>& faults);

}  // namespace msml
