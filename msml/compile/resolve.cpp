// SPDX-License-Identifier: GPL-3.0-or-later
// Text of an attribute -> literal or edge.
#include <fmt/format.h>

#include <algorithm>

#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

constexpr int deepest = 32;                // variables that refer to variables
constexpr std::size_t longest = 1u << 20;  // of a text after all variables are filled in
constexpr int most_pieces = 10'000;        // of such a text

std::vector<std::string> scope_names(const Work& work) {
  std::vector<std::string> names;
  for (const auto& [name, named] : work.scope) names.push_back(name);
  return names;
}

void unknown_name(Work& work, const std::string& name, const Location& where) {
  constexpr std::size_t hinted = 100;  // a scene of faults need not be compared with itself
  work.fault(where, fmt::format("${{{}}} names no variable, task or output{}", quoted_value(name),
                                work.out.faults.size() < hinted ? did_you_mean(name, scope_names(work)) : ""));
}

/// "task.slot" -> the name and the slot; a plain name has no slot.
std::pair<std::string, std::string> split_reference(const std::string& reference) {
  const std::size_t dot = reference.find('.');
  if (dot == std::string::npos) return {reference, ""};
  return {reference.substr(0, dot), reference.substr(dot + 1)};
}

/// Output slot of a node named in a reference; -1 after a fault.
int output_slot(Work& work, const Node& node, const std::string& slot, const std::string& reference,
                const Location& where) {
  std::vector<std::string> outputs;
  for (std::size_t i = 0; i < node.op->slots().size(); ++i) {
    const Slot& each = node.op->slots()[i];
    if (each.role != Role::output) continue;
    if (slot.empty() || each.name == slot) return static_cast<int>(i);
    outputs.push_back(each.name);
  }
  if (slot.empty()) {
    work.fault(where, fmt::format("${{{}}}: {} has no output", reference, node.op->tag()));
  } else {
    std::string list;
    for (const std::string& each : outputs) list += (list.empty() ? "" : ", ") + each;
    work.fault(where,
               fmt::format("${{{}}}: {} at line {} has no output {}{}; it has {}", quoted_value(reference),
                           node.op->tag(), node.where.line, quoted_value(slot), did_you_mean(slot, outputs), list));
  }
  return -1;
}

Source resolve_reference(Work& work, const Binding& user, const Slot& slot, const std::string& reference,
                         const Location& where) {
  const auto [name, part] = split_reference(reference);
  const auto found = work.scope.find(name);
  if (found == work.scope.end()) {
    unknown_name(work, name, where);
    return Value{};
  }
  const Named& named = found->second;
  if (named.kind == Named::Kind::variable) {
    work.fault(where, fmt::format("${{{}}}: {} is the variable at line {}, which has no outputs",
                                  quoted_value(reference), name, named.where.line));
    return Value{};
  }
  if (named.kind == Named::Kind::output) {
    if (!part.empty())
      work.fault(where, fmt::format("${{{}}}: the output {} has no parts", quoted_value(reference), name));
    return connect(work, user, slot, {named.nodes.front(), named.slot}, where, reference);
  }
  if (named.nodes.empty()) return Value{};
  const int output = output_slot(work, work.node(named.nodes.front()), part, reference, where);
  if (output < 0) return Value{};
  std::vector<Edge> edges;
  for (const int node : named.nodes) edges.push_back({node, output});
  return connect_all(work, user, slot, edges, where, reference);
}

Source resolve_literal(Work& work, const Binding& user, const Slot& slot, const std::string& text,
                       const std::string& logical, const Location& where, const Location& from) {
  const bool from_file = (is_data(slot.type) && slot.type != Type::index_set) || slot.type == Type::file;
  if (from_file) return resolve_file(work, user, slot, trimmed(text), logical, where);
  Parsed parsed = parse_literal(slot, text, indexed_by(logical, slot.indexes));
  if (!parsed.problem.empty()) {
    const bool elsewhere = !(from == where);
    work.fault(where, parsed.problem + (elsewhere ? fmt::format(" (from the variable at line {})", from.line) : ""));
    return Value{};
  }
  return parsed.value;
}

/// A text joined from plain parts and variables; a task inside is a fault.
void refuse_joined_task(Work& work, const std::vector<Piece>& parts, const Slot& slot, const Location& where) {
  for (const Piece& piece : parts) {
    if (!piece.reference) continue;
    const auto found = work.scope.find(split_reference(piece.text).first);
    if (found == work.scope.end())
      unknown_name(work, piece.text, where);
    else if (found->second.kind != Named::Kind::variable)
      work.fault(where, fmt::format("{}: ${{{}}} is the result of a task and cannot be joined with text", slot.name,
                                    piece.text));
    else if (!plain_text(work, "${" + piece.text + "}"))
      work.fault(where, fmt::format("{}: the variable {} (line {}) does not stand for text: it leads to a task, to no "
                                    "name, back to itself, or grows without bound",
                                    slot.name, piece.text, found->second.where.line));
  }
}

/// Operators that turn one type into the other, for the hint of a type error.
std::string conversion_hint(const Work& work, Type from, Type to) {
  std::string hint;
  for (const auto& op : work.registry.operators()) {
    const int output = op->first_output();
    if (output < 0 || op->slots()[static_cast<std::size_t>(output)].type != to) continue;
    int inputs = 0, fitting = 0, required = 0;
    for (const Slot& slot : op->slots()) {
      inputs += slot.role == Role::input;
      fitting += slot.role == Role::input && slot.type == from;
      required += slot.role == Role::parameter && slot.required;
    }
    if (inputs == 1 && fitting == 1 && required == 0) hint += (hint.empty() ? "" : ", ") + op->tag();
  }
  return hint.empty() ? "" : "; between them: " + hint;
}

/// Adds the text with its variables filled in to `joined`; false where it has none, or where it would grow too long.
bool append_plain(Work& work, const std::string& text, int depth, int& pieces_left, std::string& joined) {
  std::string problem;
  const auto parts = pieces(text, problem);
  if (!problem.empty() || depth > deepest) return false;
  for (const Piece& piece : parts) {
    if (--pieces_left < 0 || (depth > 0 && joined.size() + piece.text.size() > longest)) return false;
    if (!piece.reference) {
      joined += piece.text;
      continue;
    }
    const auto found = work.scope.find(piece.text);
    if (found == work.scope.end() || found->second.kind != Named::Kind::variable) return false;
    found->second.variable.used = true;
    if (!append_plain(work, found->second.variable.value, depth + 1, pieces_left, joined)) return false;
  }
  return true;
}

bool has_file(const Node& node, int slot) {
  if (node.kind == NodeKind::file || node.output_type(slot) == Type::series) return true;
  return std::any_of(node.targets.begin(), node.targets.end(), [slot](const Target& t) { return t.output == slot; });
}

/// A number without a unit is counted in "1" until the variable fills an attribute that has one.
void note_unit(Variable& variable, const Slot& slot) {
  const bool number = slot.type == Type::number || slot.type == Type::integer;
  const bool known = !variable.unit.empty() && variable.unit != "1";
  if (known && !slot.unit.empty() && slot.unit != variable.unit) variable.ambiguous = true;
  if (known) return;
  if (!slot.unit.empty())
    variable.unit = slot.unit;
  else if (number)
    variable.unit = "1";
}

}  // namespace

std::string owner(const Binding& user) {
  return user.id.empty() ? user.description->tag()
                         : fmt::format("{} '{}'", user.description->tag(), quoted_value(user.id));
}

std::optional<std::string> plain_text(Work& work, const std::string& text) {
  int pieces_left = most_pieces;
  std::string joined;
  if (!append_plain(work, text, 0, pieces_left, joined)) return std::nullopt;
  return joined;
}

Source connect_all(Work& work, const Binding& user, const Slot& slot, const std::vector<Edge>& edges,
                   const Location& where, const std::string& reference) {
  if (edges.size() == 1) return connect(work, user, slot, edges.front(), where, reference);
  if (slot.type != Type::images) {
    work.fault(where, fmt::format("{} of {} takes one {}, but ${{{}}} runs once per file and gives {}", slot.name,
                                  owner(user), name(slot.type), reference, edges.size()));
    return Value{};
  }
  for (const Edge& edge : edges)
    if (std::holds_alternative<Value>(connect(work, user, slot, edge, where, reference))) return Value{};
  return edges;
}

Source connect(Work& work, const Binding& user, const Slot& slot, Edge edge, const Location& where,
               const std::string& reference) {
  const Node& node = work.node(edge.node);
  const Type from = node.output_type(edge.slot);
  if (slot.role == Role::target) {
    work.fault(where, fmt::format("{} of {} is the name of a file to write, but ${{{}}} is the {} of {} at line {}",
                                  slot.name, owner(user), reference, name(from), node.tag(), node.where.line));
    return Value{};
  }
  if (slot.type == Type::file) {
    if (from == Type::file || has_file(node, edge.slot)) return edge;
    work.fault(where, fmt::format("{} of {} needs a file, but ${{{}}} of {} at line {} is not written to one: name a "
                                  "target there",
                                  slot.name, owner(user), reference, node.tag(), node.where.line));
    return Value{};
  }
  if (from != Type::file && converts(from, slot.type)) return edge;
  work.fault(where,
             fmt::format("{} of {} needs {}, but ${{{}}} is the {} '{}' of {} at line {}{}", slot.name, owner(user),
                         with_article(slot.type), reference, name(from), node.output_name(edge.slot), node.tag(),
                         node.where.line, conversion_hint(work, from, slot.type)));
  return Value{};
}

Source resolve(Work& work, const Binding& user, const Slot& slot, const std::string& text, const Location& where) {
  std::string current = text, logical;
  Location from = where;
  for (int depth = 0; depth < deepest; ++depth) {
    std::string problem;
    const auto parts = pieces(trimmed(current), problem);
    if (!problem.empty()) {
      work.fault(where, fmt::format("{} = {}: {}", slot.name, quoted_value(current), problem));
      return Value{};
    }
    const bool any = std::any_of(parts.begin(), parts.end(), [](const Piece& piece) { return piece.reference; });
    if (!any) return resolve_literal(work, user, slot, current, logical, where, from);
    if (parts.size() > 1) {
      const auto joined = plain_text(work, current);
      if (joined) return resolve_literal(work, user, slot, *joined, logical, where, from);
      refuse_joined_task(work, parts, slot, where);
      return Value{};
    }
    const auto found = work.scope.find(parts.front().text);
    if (found == work.scope.end() || found->second.kind != Named::Kind::variable)
      return resolve_reference(work, user, slot, parts.front().text, where);
    found->second.variable.used = true;
    note_unit(found->second.variable, slot);
    logical = found->second.variable.logical;
    from = found->second.variable.where;
    current = found->second.variable.value;
  }
  work.fault(where, fmt::format("{} = {}: the variables refer to each other in a circle", slot.name,
                                quoted_value(trimmed(text))));
  return Value{};
}

}  // namespace msml
