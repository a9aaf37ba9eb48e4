// SPDX-License-Identifier: GPL-3.0-or-later
// Values along the edges.
#include "msml/run/gather.hpp"

#include <fmt/format.h>

#include "msml/compile/literal.hpp"

namespace msml {
namespace {

/// The file that holds the value of an edge: read from it, written to it, or the last of a series.
File file_of(const Graph& graph, const Edge& edge, const Value& value, const std::filesystem::path& output_folder) {
  if (const auto* file = std::get_if<File>(&value)) return *file;
  if (const auto* series = std::get_if<SeriesPtr>(&value)) {
    if ((*series)->files.empty()) throw Error("the series has no state on disk");
    return {(*series)->files.back()};
  }
  const Node& node = graph.nodes[static_cast<std::size_t>(edge.node)];
  if (node.kind == NodeKind::file) return {node.file};
  for (const Target& target : node.targets)
    if (target.output == edge.slot) return {output_folder / target.file};
  throw Error(node.tag() + " writes no file");
}

class Gatherer {
 public:
  Gatherer(const Graph& graph, const Results& results, const std::filesystem::path& output_folder)
      : graph_(graph), results_(results), output_folder_(output_folder) {}

  Record record(const Binding& binding) const {
    Record out{.description = binding.description, .where = binding.where, .id = binding.id, .given = binding.given};
    const auto& slots = binding.description->slots();
    for (std::size_t i = 0; i < binding.sources.size(); ++i) {
      try {
        out.values.push_back(value(binding.sources[i], slots[i].type));
      } catch (const Error& error) {
        throw Error(slots[i].name + ": " + error.what(), binding.places[i], error.failure());
      }
      if (std::holds_alternative<Value>(binding.sources[i])) continue;  // checked when the scene was compiled
      if (const std::string problem = value_problem(slots[i], out.values.back()); !problem.empty())
        throw Error(problem, binding.places[i]);
    }
    for (const Binding& child : binding.children) out.children.push_back(record(child));
    return out;
  }

 private:
  Value value(const Source& source, Type wanted) const {
    if (const auto* literal = std::get_if<Value>(&source)) return *literal;
    if (const auto* edge = std::get_if<Edge>(&source)) return along(*edge, wanted);
    ImageList images;
    for (const Edge& edge : std::get<std::vector<Edge>>(source))
      images.push_back(std::get<ImagePtr>(along(edge, Type::image)));
    return images;
  }

  Value along(const Edge& edge, Type wanted) const {
    const auto& outputs = results_[static_cast<std::size_t>(edge.node)];
    const Value nothing;
    const Value& from =
        static_cast<std::size_t>(edge.slot) < outputs.size() ? outputs[static_cast<std::size_t>(edge.slot)] : nothing;
    if (wanted == Type::file) return file_of(graph_, edge, from, output_folder_);
    if (type(from) == Type::nothing) {
      const Node& node = graph_.nodes[static_cast<std::size_t>(edge.node)];
      throw Error(fmt::format("{} '{}' gave no {}", node.tag(), node.id, node.output_name(edge.slot)));
    }
    return convert(from, wanted);
  }

  const Graph& graph_;
  const Results& results_;
  const std::filesystem::path& output_folder_;
};

}  // namespace

Record gather(const Graph& graph, const Binding& binding, const Results& results,
              const std::filesystem::path& output_folder) {
  return Gatherer(graph, results, output_folder).record(binding);
}

}  // namespace msml
