// SPDX-License-Identifier: GPL-3.0-or-later
// Everything the language knows: operators, the tags of a scene, and the file formats.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "msml/core/operator.hpp"

namespace msml {

/// A file format: which extensions, which types of value it can hold, how to read and write it.
struct Format {
  std::vector<std::string> extensions;  ///< lower case with the dot: ".vtu", ".inr.gz"
  std::string doc;
  std::vector<Type> reads, writes;
  /// Reads the file as a value of the wanted type. Throws Error.
  std::function<Value(const std::filesystem::path&, Type)> read;
  /// Writes to exactly this path (which may have a temporary name); `extension` tells the format.
  std::function<void(const Value&, const std::filesystem::path&, const std::string& extension)> write;
};

/// Filled once by main (and by tests), then read only.
class Registry {
 public:
  /// Throws an internal Error if the tag is already known in the same category.
  void add(Operator op);
  void add(std::shared_ptr<const Description> description);
  void add(Format format);

  const std::vector<std::shared_ptr<const Operator>>& operators() const { return operators_; }
  const std::vector<std::shared_ptr<const Description>>& descriptions() const { return descriptions_; }
  const std::vector<Format>& formats() const { return formats_; }

  const Operator* find_operator(const std::string& tag) const;  ///< or null
  /// The description with this tag in one of the categories (an operator too), or null.
  const Description* find(const std::string& tag, const std::vector<std::string>& categories) const;
  std::vector<const Description*> of_category(const std::string& category) const;
  std::vector<std::string> operator_tags() const;

  /// The longest known extension that the file name ends in (case ignored), or "".
  std::string extension(const std::filesystem::path& path) const;
  /// The format of a file name, or null.
  const Format* format(const std::filesystem::path& path) const;
  /// Extensions whose format reads (or writes) the type, for messages.
  std::vector<std::string> extensions_for(Type type, bool writing) const;

  /// Reads a file as a value of the type. Throws Error naming the file and the extensions that would do.
  Value read(const std::filesystem::path& path, Type type) const;
  /// Writes a value whole or not at all: temporary name, fsync, rename.
  void write(const Value& value, const std::filesystem::path& path) const;

 private:
  std::vector<std::shared_ptr<const Operator>> operators_;
  std::vector<std::shared_ptr<const Description>> descriptions_;
  std::vector<Format> formats_;
};

}  // namespace msml
