// SPDX-License-Identifier: GPL-3.0-or-later
// Help and lists.
#include "msml/commands/help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "msml/core/formula.hpp"

namespace msml {
namespace {

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width = 100) {
  std::string out, line;
  const std::string margin(indent, ' ');
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    const std::string word = text.substr(i, end - i);
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
      out += margin + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    i = end + 1;
  }
  return out + margin + line + "\n";
}

std::string fallback_text(const Slot& slot) {
  if (type(slot.fallback) == Type::nothing) return {};
  if (const auto* list = std::get_if<std::vector<double>>(&slot.fallback))
    return fmt::format("{}", fmt::join(*list, " "));
  if (const auto* list = std::get_if<std::vector<Integer>>(&slot.fallback))
    return fmt::format("{}", fmt::join(*list, " "));
  if (const auto* list = std::get_if<Formulas>(&slot.fallback)) {
    std::string all;
    for (const Formula& entry : *list) all += (all.empty() ? "" : " ") + summary(Value(entry));
    return all;
  }
  const std::string text = summary(slot.fallback);
  return text.empty() ? "''" : text;
}

std::string slot_text(const Slot& slot) {
  std::string facts = name(slot.type);
  if (slot.role == Role::target) facts = "file name, written";
  if (!slot.unit.empty()) facts += ", " + slot.unit;
  if (slot.range.bounded()) facts += ", " + slot.range.str();
  if (!slot.choices.empty())
    facts += fmt::format(", {} of {}", slot.type == Type::words ? "each one" : "one", fmt::join(slot.choices, " | "));
  if (!slot.counts.empty()) facts += fmt::format(", {} values", fmt::join(slot.counts, " or "));
  if (slot.multiple_of > 1) facts += fmt::format(", a multiple of {} values", slot.multiple_of);
  const std::string fallback = fallback_text(slot);
  if (!fallback.empty())
    facts += ", default " + fallback;
  else if (slot.required)
    facts += ", required";
  else if (slot.role != Role::output)
    facts += ", optional";
  return fmt::format("  {}  ({})\n", slot.name, facts) + wrapped(slot.doc, 6);
}

std::string slots_text(const Description& description, bool outputs) {
  std::string text;
  for (const Slot& slot : description.slots())
    if ((slot.role == Role::output) == outputs) text += slot_text(slot);
  return text;
}

std::string rules_text(const Registry& registry, const Description& description) {
  std::string text;
  for (const ChildRule& rule : description.children()) {
    std::vector<std::string> tags;
    for (const Description* child : registry.of_category(rule.category)) tags.push_back(child->tag());
    if (tags.empty()) continue;
    text += wrapped(fmt::format("{}{}: {}", rule.least > 0 ? "needs" : "may hold", rule.most == 1 ? " one of" : "",
                                fmt::join(tags, ", ")),
                    2);
  }
  return text;
}

std::string description_text(const Registry& registry, const Description& description) {
  std::string text =
      fmt::format("{} ({})\n", description.tag(), description.category()) + wrapped(description.doc(), 2);
  if (!description.unavailable().empty()) text += "  Not available yet: " + description.unavailable() + "\n";
  if (!description.source().empty()) text += wrapped("Source: " + description.source(), 2);
  const std::string in = slots_text(description, false), out = slots_text(description, true);
  if (!in.empty()) text += "\nAttributes\n" + in;
  if (!out.empty()) text += "\nOutputs (the first is ${id}, each is ${id.name})\n" + out;
  const std::string inside = rules_text(registry, description);
  if (!inside.empty()) text += "\nInside\n" + inside;
  for (const Slot& slot : description.slots())
    if (slot.type == Type::formula || slot.type == Type::formulas) {
      text += "\n" + wrapped("Note: an expression may use " + formula_language() + ".", 0);
      break;
    }
  for (const std::string& note : description.notes()) text += "\n" + wrapped("Note: " + note, 0);
  return text;
}

/// All descriptions by category; operators first.
std::map<std::string, std::vector<const Description*>> by_category(const Registry& registry) {
  std::map<std::string, std::vector<const Description*>> all;
  for (const auto& op : registry.operators()) all["operator"].push_back(op.get());
  for (const auto& description : registry.descriptions()) all[description->category()].push_back(description.get());
  return all;
}

}  // namespace

std::string help_text(const Registry& registry, const std::string& tag) {
  std::string text;
  std::vector<std::string> tags;
  for (const auto& [category, descriptions] : by_category(registry))
    for (const Description* description : descriptions) {
      tags.push_back(description->tag());
      if (description->tag() != tag) continue;
      text += (text.empty() ? "" : "\n") + description_text(registry, *description);
    }
  if (text.empty())
    throw Error(fmt::format("no tag is called {}{}; `msml list` shows all", tag, did_you_mean(tag, tags)));
  return text;
}

std::string list_text(const Registry& registry, const std::string& wanted) {
  const auto all = by_category(registry);
  std::vector<std::string> categories;
  for (const auto& [category, descriptions] : all) categories.push_back(category);
  // "materials" means the laws, not the tag <material> around them.
  std::string singular = wanted;
  for (const std::string& ending : {std::string("s"), std::string("es")})
    if (wanted.ends_with(ending) && all.contains(wanted.substr(0, wanted.size() - ending.size())))
      singular = wanted.substr(0, wanted.size() - ending.size());
  if (!wanted.empty() && !all.contains(singular))
    throw Error(fmt::format("no category is called {}{}; there are {}", wanted, did_you_mean(wanted, categories),
                            fmt::join(categories, ", ")));
  std::string text;
  for (const auto& [category, descriptions] : all) {
    if (!wanted.empty() && category != singular) continue;
    std::size_t width = 0;
    for (const Description* each : descriptions) width = std::max(width, each->tag().size());
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", category);
    for (const Description* each : descriptions)
      text += fmt::format("  {:<{}}  {}{}\n", each->tag(), width,
                          each->unavailable().empty() ? "" : "(not available yet) ", each->doc());
  }
  return text;
}

}  // namespace msml
