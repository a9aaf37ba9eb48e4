// SPDX-License-Identifier: GPL-3.0-or-later
// Names of variables and tasks, and the files that tasks write.
#include <fmt/format.h>

#include <algorithm>

#include "msml/compile/grammar.hpp"
#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

/// A name must be usable inside ${…}: no blanks, braces, dots or dollar signs.
bool usable_name(const std::string& name) {
  return !name.empty() && name.find_first_of(" \t\r\n${}.\"'") == std::string::npos;
}

std::string text_of(const Binding& binding, const Key<std::string>& key) {
  const auto* value = std::get_if<Value>(&binding.sources[static_cast<std::size_t>(key.slot)]);
  const auto* text = value ? std::get_if<std::string>(value) : nullptr;
  return text ? *text : std::string();
}

void declare_task(Work& work, const Tag& tag) {
  for (const Tag& inner : tag.children) declare_task(work, inner);
  const Attribute* id = tag.element->find("id");
  const auto* op = dynamic_cast<const Operator*>(tag.description);
  if (!op) {  // not available yet, as reported; its name is declared so that its users add no faults of their own
    if (id) declare(work, trimmed(id->value), {.kind = Named::Kind::task, .where = id->where});
    return;
  }
  Task task{.tag = &tag, .id = id ? trimmed(id->value) : "", .node = static_cast<int>(work.out.graph.nodes.size())};
  if (id && !usable_name(task.id))
    work.fault(id->where, fmt::format("id = '{}' is not a name: no blanks, dots, braces or $", quoted_value(task.id)));
  Node node;
  node.where = tag.element->where;
  node.op = op;
  node.id = id ? task.id : fmt::format("{}_line{}", op->tag(), node.where.line);
  work.out.graph.nodes.push_back(std::move(node));
  if (id) declare(work, task.id, {.kind = Named::Kind::task, .where = id->where, .nodes = {task.node}});
  work.tasks.push_back(std::move(task));
}

/// The attribute whose text, variables filled in, is a pattern for an input that takes one value; or null.
const Attribute* star_attribute(Work& work, const Task& task, std::string& pattern) {
  for (const Attribute& attribute : task.tag->element->attributes) {
    const int slot = task.tag->description->find(attribute.name);
    if (slot < 0) continue;
    const Slot& described = task.tag->description->slots()[static_cast<std::size_t>(slot)];
    if (described.role != Role::input || described.type == Type::images) continue;
    const auto text = plain_text(work, attribute.value);
    if (text && text->find('*') != std::string::npos) {
      pattern = trimmed(*text);
      return &attribute;
    }
  }
  return nullptr;
}

/// One copy of the task per matching file.
void split_task(Work& work, Task task, const std::string& attribute, const std::string& pattern,
                std::vector<Task>& split) {
  const Location& where = task.tag->element->find(attribute)->where;
  const auto files = matching_files(work, pattern);
  if (files.empty()) {
    work.fault(where, fmt::format("{} = {} matches no file beside the scene and no task's target", attribute,
                                  quoted_value(pattern)));
    task.star_attribute = attribute;  // reported here, so no more of it is said when the task is bound
    split.push_back(std::move(task));
    return;
  }
  const std::string id = work.node(task.node).id;
  std::vector<int> nodes;
  for (const std::string& file : files) {
    Task each = task;
    each.mapped = true;
    each.star_attribute = attribute;
    each.star_file = file;
    matches(pattern, file, &each.star);
    if (!nodes.empty()) {
      each.node = static_cast<int>(work.out.graph.nodes.size());
      work.out.graph.nodes.push_back(work.node(task.node));
    }
    nodes.push_back(each.node);
    split.push_back(std::move(each));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    work.node(nodes[i]).id = fmt::format("{}[{}]", id, split[split.size() - nodes.size() + i].star);
  if (const auto named = work.scope.find(task.id); named != work.scope.end()) named->second.nodes = nodes;
}

bool writable(Work& work, Type type, const std::string& file, const Location& where, const std::string& attribute) {
  const bool verbatim = type == Type::file || !is_data(type);
  if (verbatim) return true;
  const auto endings = work.registry.extensions_for(type, true);
  if (std::find(endings.begin(), endings.end(), work.registry.extension(file)) != endings.end()) return true;
  std::string list;
  for (const std::string& ending : endings) list += " " + ending;
  work.fault(where, fmt::format("{} = {}: files that hold {} end in{}", attribute, quoted_value(file),
                                with_article(type), list));
  return false;
}

void enter_target(Work& work, const Task& task, const Slot& slot, const Attribute& attribute) {
  const auto text = plain_text(work, attribute.value);
  if (!text || trimmed(*text).empty()) return;  // a reference to a task is reported when the task is bound
  const std::string file = task.mapped ? with_star(trimmed(*text), task.star) : trimmed(*text);
  Node& node = work.node(task.node);
  if (!writable(work, node.output_type(slot.written_output), file, attribute.where, attribute.name)) return;
  const auto [found, fresh] =
      work.written.insert({same_file(file), {{task.node, slot.written_output}, attribute.where}});
  if (!fresh && task.mapped && found->second.where == attribute.where) {
    work.fault(attribute.where,
               fmt::format("{} = {} is one file, but the task runs once per file that matches {}; put a * "
                           "into it",
                           attribute.name, quoted_value(file), task.star_attribute));
    return;
  }
  if (!fresh) {
    work.fault(attribute.where, fmt::format("{} = {} is also written at line {}", attribute.name, quoted_value(file),
                                            found->second.where.line));
    return;
  }
  node.targets.push_back({slot.written_output, file, attribute.where});
}

void enter_targets(Work& work, const Task& task) {
  for (const Attribute& attribute : task.tag->element->attributes) {
    const int slot = task.tag->description->find(attribute.name);
    if (slot < 0) continue;
    const Slot& described = task.tag->description->slots()[static_cast<std::size_t>(slot)];
    if (described.role == Role::target) enter_target(work, task, described, attribute);
  }
}

/// True if the pattern matches what a task that is still to be split will write.
bool will_write(Work& work, const Task& task, const std::string& pattern) {
  for (const Attribute& attribute : task.tag->element->attributes) {
    const int slot = task.tag->description->find(attribute.name);
    if (slot < 0 || task.tag->description->slots()[static_cast<std::size_t>(slot)].role != Role::target) continue;
    const auto text = plain_text(work, attribute.value);
    if (text && matches(pattern, trimmed(*text))) return true;
  }
  return false;
}

/// The first task whose pattern waits for no other's targets; the first of all where they wait for each other.
std::vector<Task>::iterator next_to_split(Work& work, std::vector<Task>& starred) {
  const auto waits = [&](const Task& task) {
    std::string pattern;
    star_attribute(work, task, pattern);
    return std::any_of(starred.begin(), starred.end(),
                       [&](const Task& other) { return other.tag != task.tag && will_write(work, other, pattern); });
  };
  const auto next = std::find_if_not(starred.begin(), starred.end(), waits);
  return next == starred.end() ? starred.begin() : next;
}

}  // namespace

bool declare(Work& work, const std::string& name, Named named) {
  if (name.empty()) return false;
  const auto [found, fresh] = work.scope.insert({name, named});
  if (!fresh)
    work.fault(named.where, fmt::format("the name {} is taken: it is declared at line {}; variables, tasks and outputs "
                                        "share one scope",
                                        quoted_value(name), found->second.where.line));
  return fresh;
}

void declare_variables(Work& work, const Tag& variables) {
  VariableKeys keys;
  describe_variable(keys);
  for (const Tag& tag : variables.children) {
    Named named{.kind = Named::Kind::variable, .where = tag.element->where};
    const Binding binding = bind_attributes(work, tag);
    named.variable = {text_of(binding, keys.value), text_of(binding, keys.logical), tag.element->where, false, {}};
    const std::string name = text_of(binding, keys.name);
    if (!name.empty() && !usable_name(name))
      work.fault(tag.element->where,
                 fmt::format("name = '{}' is not a name: no blanks, dots, braces or $", quoted_value(name)));
    else
      declare(work, name, named);
  }
}

void apply_settings(Work& work) {
  std::vector<std::string> names;
  for (const auto& [name, named] : work.scope) names.push_back(name);
  for (const auto& [name, value] : work.options.set) {
    const auto found = work.scope.find(name);
    if (found == work.scope.end())
      work.fault({work.document.file, 0}, fmt::format("--set {}={}: the scene has no variable {}{}", name,
                                                      quoted_value(value), name, did_you_mean(name, names)));
    else
      found->second.variable.value = value;
  }
}

void declare_tasks(Work& work, const Tag& workflow) {
  for (const Tag& tag : workflow.children) declare_task(work, tag);
}

void declare_targets(Work& work) {
  std::vector<Task> plain, starred, split;
  for (Task& task : work.tasks) {
    std::string pattern;
    (star_attribute(work, task, pattern) ? starred : plain).push_back(std::move(task));
  }
  for (const Task& task : plain) enter_targets(work, task);
  while (!starred.empty()) {
    const auto next = next_to_split(work, starred);
    std::string pattern;
    const std::string attribute = star_attribute(work, *next, pattern)->name;
    const std::size_t first = split.size();
    split_task(work, *next, attribute, pattern, split);
    starred.erase(next);
    for (std::size_t i = first; i < split.size(); ++i) enter_targets(work, split[i]);
  }
  work.tasks = std::move(plain);
  std::move(split.begin(), split.end(), std::back_inserter(work.tasks));
}

}  // namespace msml
