// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups on the graph, and its picture.
#include "msml/compile/graph.hpp"

#include <fmt/format.h>

namespace msml {

std::string Node::tag() const { return op ? op->tag() : "read"; }

Type Node::output_type(int slot) const {
  if (kind == NodeKind::file) return file_type;
  if (kind == NodeKind::simulation) return result_types[static_cast<std::size_t>(slot)];
  return op->slots()[static_cast<std::size_t>(slot)].type;
}

std::string Node::output_name(int slot) const {
  if (kind == NodeKind::file) return file.filename().string();
  if (kind == NodeKind::simulation) return results[static_cast<std::size_t>(slot)];
  return op->slots()[static_cast<std::size_t>(slot)].name;
}

void collect_needs(const Binding& binding, std::vector<int>& nodes) {
  for (const Source& source : binding.sources) {
    if (const auto* edge = std::get_if<Edge>(&source)) nodes.push_back(edge->node);
    if (const auto* edges = std::get_if<std::vector<Edge>>(&source))
      for (const Edge& edge : *edges) nodes.push_back(edge.node);
  }
  for (const Binding& child : binding.children) collect_needs(child, nodes);
}

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

void edges_to_dot(const Graph& graph, const Binding& binding, std::size_t user, std::string& out) {
  const auto line = [&](const Edge& edge, std::size_t slot) {
    const Node& from = graph.nodes[static_cast<std::size_t>(edge.node)];
    out += fmt::format("  n{} -> n{} [label=\"{}\\n{}\"];\n", edge.node, user,
                       escaped(binding.description->slots()[slot].name), name(from.output_type(edge.slot)));
  };
  for (std::size_t i = 0; i < binding.sources.size(); ++i) {
    if (const auto* edge = std::get_if<Edge>(&binding.sources[i])) line(*edge, i);
    if (const auto* edges = std::get_if<std::vector<Edge>>(&binding.sources[i]))
      for (const Edge& edge : *edges) line(edge, i);
  }
  for (const Binding& child : binding.children) edges_to_dot(graph, child, user, out);
}

}  // namespace

std::string to_dot(const Graph& graph, const std::vector<bool>& runs) {
  std::string out =
      "digraph scene {\n  rankdir=LR;\n  node [fontname=\"Helvetica\" fontsize=11 shape=box];\n"
      "  edge [fontname=\"Helvetica\" fontsize=9 color=gray40];\n";
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    const char* shape = node.kind == NodeKind::file ? "note" : node.kind == NodeKind::simulation ? "box3d" : "box";
    std::string style = runs[i] ? "" : " style=dashed color=gray60 fontcolor=gray60";
    out +=
        fmt::format("  n{} [label=\"{}\\n{}\" shape={}{}];\n", i, escaped(node.tag()), escaped(node.id), shape, style);
    for (const Target& target : node.targets) {
      const std::string file = escaped(target.file.string());
      out += fmt::format("  \"file {0}\" [label=\"{0}\" shape=note style=filled fillcolor=lightyellow];\n", file);
      out += fmt::format("  n{} -> \"file {}\";\n", i, file);
    }
    if (node.args.description) edges_to_dot(graph, node.args, i, out);
  }
  return out + "}\n";
}

}  // namespace msml
