// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of tags -> sources, with the faults of names, types and ranges.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msml/compile/grammar.hpp"
#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

std::string label(const Element& element) {
  for (const char* name : {"id", "name"})
    if (const Attribute* attribute = element.find(name)) return trimmed(attribute->value);
  return {};
}

void unknown_attribute(Work& work, const Tag& tag, const Attribute& attribute) {
  std::vector<std::string> known;
  for (const Slot& slot : tag.description->slots())
    if (slot.role != Role::output) known.push_back(slot.name);
  const std::string hint = did_you_mean(attribute.name, known);
  const std::string list =
      hint.empty() && !known.empty() && known.size() <= 12 ? fmt::format("; it has {}", fmt::join(known, ", ")) : "";
  work.fault(attribute.where, fmt::format("{} has no attribute {}{}{}", tag.description->tag(),
                                          quoted_value(attribute.name), hint, list));
}

/// A step may be named with or without ${}; steps are not in the scope of variables and tasks.
std::string step_name(const std::string& text) {
  const std::string inner = trimmed(text);
  if (inner.starts_with("${") && inner.ends_with("}")) return trimmed(inner.substr(2, inner.size() - 3));
  return inner;
}

void check_step(Work& work, const std::string& name, const Location& where) {
  if (name.empty() || std::find(work.steps.begin(), work.steps.end(), name) != work.steps.end()) return;
  const std::string steps = work.steps.empty() ? "no step of the scene has a name"
                                               : fmt::format("the steps are {}", fmt::join(work.steps, ", "));
  work.warn(where, fmt::format("forStep = {} names no step, so this never acts; {}{}", quoted_value(name), steps,
                               did_you_mean(name, work.steps)));
}

void bind_attribute(Work& work, Binding& binding, std::size_t i, const Attribute& attribute) {
  const Slot& slot = binding.description->slots()[i];
  binding.places[i] = attribute.where;
  binding.given[i] = true;
  if (slot.name == "forStep") {
    const std::string name = step_name(attribute.value);
    check_step(work, name, attribute.where);
    binding.sources[i] = Value{name};
  } else if (binding.description->category() == "var" && slot.choices.empty()) {
    binding.sources[i] = Value{attribute.value};  // resolved where the variable is used
  } else if (slot.role != Role::target) {
    binding.sources[i] = resolve(work, binding, slot, attribute.value, attribute.where);
  } else if (!plain_text(work, attribute.value)) {
    resolve(work, binding, slot, attribute.value, attribute.where);  // for its fault
  }
}

void report_missing(Work& work, const Binding& binding) {
  const auto& slots = binding.description->slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto* value = std::get_if<Value>(&binding.sources[i]);
    const bool absent = value && type(*value) == Type::nothing && !binding.given[i];
    if (slots[i].required && absent)
      work.fault(binding.where,
                 fmt::format("{} needs the attribute {}: {}", binding.description->tag(), slots[i].name, slots[i].doc));
  }
}

Binding bind_given(Work& work, const Tag& tag, const std::string& star_attribute = {},
                   const std::string& star_file = {}) {
  Binding binding = bind_defaults(*tag.description, tag.element->where);
  binding.id = label(*tag.element);
  for (const Attribute& attribute : tag.element->attributes) {
    const int slot = tag.description->find(attribute.name);
    if (slot >= 0) {
      if (attribute.name == star_attribute && star_file.empty()) {
        binding.given[static_cast<std::size_t>(slot)] = true;
        continue;
      }
      Attribute each = attribute;
      if (attribute.name == star_attribute) each.value = star_file;
      bind_attribute(work, binding, static_cast<std::size_t>(slot), each);
    } else if (tag.description->category() == "operator" && attribute.name == "id") {
      continue;
    } else if (is_legacy_attribute(tag.description->tag(), attribute.name)) {
      work.note(attribute.where,
                fmt::format("{} of {} is accepted, but has no meaning", attribute.name, tag.description->tag()));
    } else {
      binding.misread = true;
      unknown_attribute(work, tag, attribute);
    }
  }
  return binding;
}

/// First outputs of nested tasks feed the inputs that the outer one leaves unset, in order.
void feed_nested(Work& work, Binding& binding, const Tag& tag) {
  std::size_t i = 0;
  const auto& slots = binding.description->slots();
  for (const Tag& inner : tag.children) {
    while (i < slots.size() && (slots[i].role != Role::input || binding.given[i])) ++i;
    const int output = static_cast<const Operator*>(inner.description)->first_output();
    if (i == slots.size() || output < 0) {
      work.fault(inner.element->where, output < 0 ? fmt::format("{} has no output that could feed {}",
                                                                inner.description->tag(), owner(binding))
                                                  : fmt::format("{} has no unset input left for the nested {}",
                                                                owner(binding), inner.description->tag()));
      return;
    }
    std::vector<Edge> edges;
    for (const Task& task : work.tasks)
      if (task.tag == &inner) edges.push_back({task.node, output});
    binding.given[i] = true;
    binding.places[i] = inner.element->where;
    const std::string reference = edges.empty() ? "" : work.node(edges.front().node).id;
    if (!edges.empty())
      binding.sources[i] = connect_all(work, binding, slots[i], edges, inner.element->where, reference);
  }
}

/// A series with useAsterisk whose user also writes a pattern is taken state by state.
void detect_each_state(Work& work, Node& node) {
  for (std::size_t i = 0; i < node.args.sources.size(); ++i) {
    const auto* edge = std::get_if<Edge>(&node.args.sources[i]);
    if (!edge || node.op->slots()[i].type != Type::mesh) continue;
    const bool series = work.node(edge->node).output_type(edge->slot) == Type::series;
    const bool pattern = std::any_of(node.targets.begin(), node.targets.end(), [](const Target& target) {
      return target.file.string().find('*') != std::string::npos;
    });
    if (series && pattern) node.each_state = static_cast<int>(i);
  }
  if (node.each_state >= 0) return;
  for (const Target& target : node.targets)
    if (target.file.string().find('*') != std::string::npos)
      work.fault(target.where, fmt::format("{} is a pattern, but no input of {} is a pattern or a series",
                                           quoted_value(target.file.string()), owner(node.args)));
}

}  // namespace

Binding bind_defaults(const Description& description, const Location& where) {
  Binding binding{.description = &description, .where = where};
  for (const Slot& slot : description.slots()) binding.sources.emplace_back(slot.fallback);
  binding.places.assign(binding.sources.size(), where);
  binding.given.assign(binding.sources.size(), false);
  return binding;
}

Binding bind_attributes(Work& work, const Tag& tag) {
  Binding binding = bind_given(work, tag);
  report_missing(work, binding);
  return binding;
}

Binding bind_tree(Work& work, const Tag& tag) {
  Binding binding = bind_attributes(work, tag);
  for (const Tag& inner : tag.children) binding.children.push_back(bind_tree(work, inner));
  return binding;
}

void bind_tasks(Work& work) {
  for (const Task& task : work.tasks) {
    Binding binding = bind_given(work, *task.tag, task.star_attribute, task.star_file);
    binding.id = task.id;
    feed_nested(work, binding, *task.tag);
    report_missing(work, binding);
    Node& node = work.node(task.node);
    node.args = std::move(binding);
    if (task.mapped || task.star_attribute.empty()) detect_each_state(work, node);
  }
}

}  // namespace msml
