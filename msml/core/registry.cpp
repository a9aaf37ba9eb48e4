// SPDX-License-Identifier: GPL-3.0-or-later
// Look-up by tag and by file extension.
#include "msml/core/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msml/core/atomic_file.hpp"

namespace msml {
namespace {

bool holds(const std::vector<Type>& types, Type type) {
  if (type == Type::images) type = Type::image;
  return std::find(types.begin(), types.end(), type) != types.end();
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

void Registry::add(Operator op) {
  if (find_operator(op.tag())) throw Error("operator " + op.tag() + " is described twice", {}, Failure::internal);
  operators_.push_back(std::make_shared<const Operator>(std::move(op)));
}

void Registry::add(std::shared_ptr<const Description> description) {
  if (find(description->tag(), {description->category()}))
    throw Error(description->category() + " " + description->tag() + " is described twice", {}, Failure::internal);
  descriptions_.push_back(std::move(description));
}

void Registry::add(Format format) { formats_.push_back(std::move(format)); }

const Operator* Registry::find_operator(const std::string& tag) const {
  for (const auto& op : operators_)
    if (op->tag() == tag) return op.get();
  return nullptr;
}

const Description* Registry::find(const std::string& tag, const std::vector<std::string>& categories) const {
  for (const std::string& category : categories) {
    if (category == "operator")
      if (const Operator* op = find_operator(tag)) return op;
    for (const auto& description : descriptions_)
      if (description->category() == category && description->tag() == tag) return description.get();
  }
  return nullptr;
}

std::vector<const Description*> Registry::of_category(const std::string& category) const {
  std::vector<const Description*> found;
  if (category == "operator")
    for (const auto& op : operators_) found.push_back(op.get());
  for (const auto& description : descriptions_)
    if (description->category() == category) found.push_back(description.get());
  return found;
}

std::vector<std::string> Registry::operator_tags() const {
  std::vector<std::string> tags;
  for (const auto& op : operators_) tags.push_back(op->tag());
  return tags;
}

std::string Registry::extension(const std::filesystem::path& path) const {
  const std::string file = lower(path.filename().string());
  std::string best;
  for (const Format& format : formats_)
    for (const std::string& ending : format.extensions)
      if (file.size() > ending.size() && file.ends_with(ending) && ending.size() > best.size()) best = ending;
  return best;
}

const Format* Registry::format(const std::filesystem::path& path) const {
  const std::string ending = extension(path);
  for (const Format& format : formats_)
    if (std::find(format.extensions.begin(), format.extensions.end(), ending) != format.extensions.end())
      return &format;
  return nullptr;
}

std::vector<std::string> Registry::extensions_for(Type type, bool writing) const {
  std::vector<std::string> endings;
  for (const Format& format : formats_)
    if (holds(writing ? format.writes : format.reads, type))
      endings.insert(endings.end(), format.extensions.begin(), format.extensions.end());
  return endings;
}

Value Registry::read(const std::filesystem::path& path, Type type) const {
  const Format* found = format(path);
  if (!found || !holds(found->reads, type))
    throw Error(fmt::format("cannot read {} as {}; files that hold one end in {}", path.string(), with_article(type),
                            fmt::join(extensions_for(type, false), " ")));
  if (!std::filesystem::exists(path)) throw Error("no such file: " + path.string());
  if (std::filesystem::is_directory(path)) throw Error(path.string() + " is a folder, not a file");
  return found->read(path, type);
}

void Registry::write(const Value& value, const std::filesystem::path& path) const {
  const Format* found = format(path);
  if (!found || !holds(found->writes, type(value)))
    throw Error(fmt::format("cannot write {} to {}; files that hold one end in {}", with_article(type(value)),
                            path.string(), fmt::join(extensions_for(type(value), true), " ")));
  const std::string ending = extension(path);
  write_whole(path, [&](const std::filesystem::path& temporary) { found->write(value, temporary, ending); });
}

}  // namespace msml
