// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled scene: nodes and typed edges. After compiling, the graph is the only truth.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "msml/core/operator.hpp"
#include "msml/document/document.hpp"

namespace msml {

/// Output `slot` of node `node`.
struct Edge {
  int node = -1;
  int slot = -1;
};

/// Where the value of an attribute comes from: a literal, one output, or a list of outputs.
using Source = std::variant<Value, Edge, std::vector<Edge>>;

/// A description with the sources of its attributes; a Record once the edges are resolved.
struct Binding {
  const Description* description = nullptr;
  Location where;
  std::string id;
  std::vector<Source> sources;   ///< one per slot
  std::vector<Location> places;  ///< one per slot: of the attribute, or of the tag
  std::vector<bool> given;       ///< one per slot
  bool misread = false;          ///< an attribute has no slot: what seems to be left out may be meant by it
  std::vector<Binding> children;
};

/// A file that an output is written to after the node has run.
struct Target {
  int output = -1;             ///< slot of the output
  std::filesystem::path file;  ///< relative to the output folder, or absolute
  Location where;
};

enum class NodeKind : std::uint8_t { task, simulation, file };

struct Node {
  NodeKind kind = NodeKind::task;
  std::string id;
  Location where;
  const Operator* op = nullptr;  ///< null for a file
  Binding args;                  ///< of the operator
  std::vector<Target> targets;
  std::vector<std::string> results;  ///< simulation: ids of its outputs, in the order of their slots
  std::vector<Type> result_types;
  std::filesystem::path file;      ///< file: what to read
  Type file_type = Type::nothing;  ///< file: as what
  std::string declared;            ///< file: the logical type its variable declares, or ""
  int each_state = -1;             ///< slot whose series is taken state by state; -1: as one value
  std::vector<int> needs;          ///< nodes that feed this one, ascending, distinct
  std::string tag() const;         ///< operator's tag, or "read"
  Type output_type(int slot) const;
  std::string output_name(int slot) const;
};

struct Graph {
  std::string scene;  ///< file name as given
  std::filesystem::path folder;
  std::string units;  ///< label of the scene's units, or ""
  std::vector<Node> nodes;
  std::vector<int> order;  ///< every node after all it needs; ties by place in the scene
};

/// The nodes that a binding reads from, added to `nodes`.
void collect_needs(const Binding& binding, std::vector<int>& nodes);

/// The graph in Graphviz' DOT language; nodes that will not run are dashed. `runs` has one entry per node.
std::string to_dot(const Graph& graph, const std::vector<bool>& runs);

}  // namespace msml
