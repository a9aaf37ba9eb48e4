// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of nodes: a hash over the hashes of what feeds them (Merkle 1987, doi 10.1007/3-540-48184-2_32).
#include "msml/study/keys.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace msml {
namespace {

/// The exact text of a literal: equal texts, equal values.
struct Text {
  std::string operator()(std::monostate) const { return "-"; }
  std::string operator()(bool x) const { return x ? "true" : "false"; }
  std::string operator()(Integer x) const { return fmt::format("{}", x); }
  std::string operator()(double x) const { return fmt::format("{:a}", x); }
  std::string operator()(const std::string& x) const { return fmt::format("{}:{}", x.size(), x); }
  std::string operator()(const Formula& x) const { return (*this)(x.text) + (*this)(x.number); }
  std::string operator()(const File& x) const { return (*this)(x.path.string()); }
  std::string operator()(const IndexSetPtr& x) const {
    std::string text = name(x->kind);
    for (const int id : x->ids) text += fmt::format(" {}", id);
    return text;
  }
  template <class T>
  std::string operator()(const std::vector<T>& list) const {
    std::string text = fmt::format("[{}", list.size());
    for (const T& each : list) text += " " + (*this)(each);
    return text;
  }
  /// Meshes, images and fields are never literals of a scene; if one were, its place in memory would tell it apart.
  template <class T>
  std::string operator()(const std::shared_ptr<const T>& x) const {
    return fmt::format("@{}", static_cast<const void*>(x.get()));
  }
};

class Keys {
 public:
  explicit Keys(const Graph& graph) : graph_(graph), keys_(graph.nodes.size()) {}

  std::vector<std::string> all() {
    for (const int node : graph_.order)
      keys_[static_cast<std::size_t>(node)] = hash(text(graph_.nodes[static_cast<std::size_t>(node)]));
    return keys_;
  }

 private:
  std::string edge(const Edge& edge) const {
    return fmt::format("{}.{}", keys_[static_cast<std::size_t>(edge.node)], edge.slot);
  }

  std::string source(const Source& source) const {
    if (const auto* value = std::get_if<Value>(&source)) return std::visit(Text{}, *value);
    if (const auto* one = std::get_if<Edge>(&source)) return edge(*one);
    std::string text;
    for (const Edge& each : std::get<std::vector<Edge>>(source)) text += edge(each) + ",";
    return text;
  }

  std::string binding(const Binding& binding) const {
    std::string text = fmt::format("{} '{}'(", binding.description->tag(), binding.id);
    for (std::size_t i = 0; i < binding.sources.size(); ++i)
      text += fmt::format("{}{}={};", binding.given[i] ? "" : "~", i, source(binding.sources[i]));
    for (const Binding& child : binding.children) text += this->binding(child);
    return text + ")";
  }

  std::string text(const Node& node) const {
    if (node.kind == NodeKind::file) {
      std::error_code code;
      const auto time = std::filesystem::last_write_time(node.file, code).time_since_epoch().count();
      const auto size = std::filesystem::file_size(node.file, code);
      return fmt::format("read {} {} {} {}", node.file.string(), name(node.file_type), size, time);
    }
    std::string text = fmt::format("{} each {}", binding(node.args), node.each_state);
    for (const std::string& result : node.results) text += " " + result;
    for (const Target& target : node.targets) text += fmt::format(" {}>{}", target.output, target.file.string());
    return text;
  }

  const Graph& graph_;
  std::vector<std::string> keys_;
};

}  // namespace

std::string hash(const std::string& text) {
  const XXH128_hash_t found = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", found.high64, found.low64);
}

std::vector<std::string> node_keys(const Graph& graph) { return Keys(graph).all(); }

}  // namespace msml
