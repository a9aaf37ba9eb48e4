// SPDX-License-Identifier: GPL-3.0-or-later
// Which tag may stand where.
#include "msml/compile/structure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace msml {
namespace {

std::vector<std::string> categories_in(const Description& description) {
  std::vector<std::string> names;
  for (const ChildRule& rule : description.children()) names.push_back(rule.category);
  if (description.category() == "operator" && description.children().empty()) names.push_back("operator");
  return names;
}

class Matcher {
 public:
  Matcher(const Registry& registry, std::vector<Fault>& faults) : registry_(registry), faults_(faults) {}

  Tag match(const Description& description, const Element& element) {
    Tag tag{&description, &element, {}};
    if (!description.unavailable().empty()) {
      fault(element, fmt::format("{} is not available yet: {}", element.tag, description.unavailable()));
      return tag;
    }
    const auto categories = categories_in(description);
    for (const Element& inner : element.children) {
      const Description* known = registry_.find(inner.tag, categories);
      if (known && is_task(*known))
        tag.children.push_back(match(*known, inner));
      else
        unknown(inner, element, categories);
    }
    count_children(tag);
    return tag;
  }

 private:
  /// Operators with children of their own are made by the compiler, not written in a workflow.
  static bool is_task(const Description& known) { return known.category() != "operator" || known.children().empty(); }

  void fault(const Element& element, std::string message) { faults_.push_back({element.where, std::move(message)}); }

  void unknown(const Element& inner, const Element& parent, const std::vector<std::string>& categories) {
    std::vector<std::string> allowed;
    for (const std::string& category : categories)
      for (const Description* each : registry_.of_category(category))
        if (is_task(*each)) allowed.push_back(each->tag());
    if (const std::string place = home_of(inner.tag); !place.empty()) {
      fault(inner, fmt::format("{} may not stand inside {}; its place is inside {}", inner.tag, parent.tag, place));
    } else if (allowed.empty()) {
      fault(inner, fmt::format("{} takes no tags inside, but holds {}", parent.tag, shortened(inner.tag)));
    } else {
      const std::string hint = did_you_mean(inner.tag, allowed);
      std::string list;
      if (hint.empty() && allowed.size() <= 12) list = fmt::format("; known there: {}", fmt::join(allowed, ", "));
      fault(inner, fmt::format("unknown tag {} inside {}{}{}", shortened(inner.tag), parent.tag, hint, list));
    }
  }

  /// The tag inside which `tag` may stand, or "" if no such tag is known.
  std::string home_of(const std::string& tag) const {
    for (const auto& parent : registry_.descriptions())
      if (const Description* known = registry_.find(tag, categories_in(*parent)); known && is_task(*known))
        return parent->tag();
    return {};
  }

  void count_children(const Tag& tag) {
    for (const ChildRule& rule : tag.description->children()) {
      const auto found = tag.of_category(rule.category);
      const int count = static_cast<int>(found.size());
      if (count > rule.most)
        fault(*found[static_cast<std::size_t>(rule.most)]->element,
              fmt::format("{} holds {} tags of the kind {}, but {} at most", tag.element->tag, count, words(rule),
                          rule.most == 1 ? "one" : std::to_string(rule.most)));
      if (count < rule.least && tag.element->children.size() <= tag.children.size())
        fault(*tag.element, fmt::format("{} needs {}{} inside", tag.element->tag,
                                        words(rule).find(" or ") == std::string::npos ? "" : "one of ", words(rule)));
    }
  }

  /// What a category stands for in a message: "<mesh>", "<linearTet> or <quadraticTet>".
  std::string words(const ChildRule& rule) const {
    std::vector<std::string> tags;
    for (const Description* each : registry_.of_category(rule.category))
      if (each->unavailable().empty()) tags.push_back("<" + each->tag() + ">");
    if (tags.empty()) return "<" + rule.category + ">";
    const std::string last = tags.back();
    tags.pop_back();
    return tags.empty() ? last : fmt::format("{} or {}", fmt::join(tags, ", "), last);
  }

  const Registry& registry_;
  std::vector<Fault>& faults_;
};

}  // namespace

std::vector<const Tag*> Tag::of_category(const std::string& category) const {
  std::vector<const Tag*> found;
  for (const Tag& child : children)
    if (child.description->category() == category) found.push_back(&child);
  return found;
}

const Tag* Tag::only(const std::string& category) const {
  for (const Tag& child : children)
    if (child.description->category() == category) return &child;
  return nullptr;
}

Tag match_tags(const Registry& registry, const Document& document, std::vector<Fault>& faults) {
  const Description* root = registry.find("msml", {"msml"});
  if (!root || document.root.tag != "msml") return {};
  return Matcher(registry, faults).match(*root, document.root);
}

}  // namespace msml
