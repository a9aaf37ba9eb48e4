// SPDX-License-Identifier: GPL-3.0-or-later
// Tags under a condition: one scene with several elements, laws or operators to choose from.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "msml/compile/grammar.hpp"
#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

using Values = std::map<std::string, std::string>;

Values variable_values(const Element& root, const CompileOptions& options) {
  Values values;
  for (const Element& group : root.children) {
    if (group.tag != "variables") continue;
    for (const Element& var : group.children) {
      const Attribute *name = var.find("name"), *value = var.find("value");
      if (name && value) values[trimmed(name->value)] = value->value;
    }
  }
  for (const auto& [name, value] : options.set)
    if (values.contains(name)) values[name] = value;
  return values;
}

/// The text with its variables filled in; throws Error where that cannot be done.
std::string filled(const std::string& text, const Values& values, int depth = 0) {
  std::string problem, out;
  const auto parts = pieces(text, problem);
  if (!problem.empty()) throw Error(problem);
  if (depth > 32) throw Error("the variables refer to each other in a circle");
  for (const Piece& piece : parts) {
    if (!piece.reference) {
      out += piece.text;
      continue;
    }
    const auto found = values.find(piece.text);
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    if (found == values.end())
      throw Error(fmt::format("${{{}}} is no variable{}", quoted_value(piece.text), did_you_mean(piece.text, names)));
    out += filled(found->second, values, depth + 1);
  }
  return trimmed(out);
}

std::optional<double> number(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool equal(const std::string& a, const std::string& b) {
  const auto x = number(a), y = number(b);
  return a == b || (x && y && *x == *y);
}

/// True if `left` equals one of the alternatives in `right`, which '|' divides.
bool one_of(const std::string& left, const std::string& right, const Values& values) {
  std::size_t from = 0;
  while (true) {
    const std::size_t to = std::min(right.find('|', from), right.size());
    if (equal(filled(left, values), filled(right.substr(from, to - from), values))) return true;
    if (to == right.size()) return false;
    from = to + 1;
  }
}

bool holds(const std::string& condition, const Values& values) {
  std::size_t at = condition.find('=');
  if (at == std::string::npos || at == 0 || condition.find('=', at + 1) != std::string::npos)
    throw Error("a condition is ${variable} = value, or !=, with '|' between alternatives");
  const bool differs = condition[at - 1] == '!';
  return one_of(condition.substr(0, differs ? at - 1 : at), condition.substr(at + 1), values) != differs;
}

bool stays(Element& element, const Values& values, std::vector<Fault>& faults) {
  const auto at = std::find_if(element.attributes.begin(), element.attributes.end(),
                               [](const Attribute& attribute) { return attribute.name == when_attribute; });
  if (at == element.attributes.end()) return true;
  const Attribute attribute = *at;
  element.attributes.erase(at);
  try {
    return holds(attribute.value, values);
  } catch (const Error& error) {
    faults.push_back({attribute.where, fmt::format("when = {}: {}", quoted_value(attribute.value), error.what())});
    return false;
  }
}

void choose(Element& element, const Values& values, std::vector<Fault>& faults) {
  std::erase_if(element.children, [&](Element& child) { return !stays(child, values, faults); });
  for (Element& child : element.children) choose(child, values, faults);
}

}  // namespace

Document choose_tags(const Document& document, const CompileOptions& options, std::vector<Fault>& faults) {
  Document chosen = document;
  choose(chosen.root, variable_values(document.root, options), faults);
  return chosen;
}

}  // namespace msml
