// SPDX-License-Identifier: GPL-3.0-or-later
// Dependency order, cycles, and outputs that would overwrite inputs.
#include <fmt/format.h>

#include <algorithm>
#include <queue>

#include "msml/compile/work.hpp"

namespace msml {
namespace {

/// A cycle among the nodes that no order could place, the first in the scene first. Each of them needs another of them,
/// so walking from need to need comes back to a node met before.
std::vector<int> find_cycle(const Graph& graph, const std::vector<int>& order) {
  std::vector<bool> left(graph.nodes.size(), true);
  for (const int node : order) left[static_cast<std::size_t>(node)] = false;
  std::vector<int> path{static_cast<int>(std::find(left.begin(), left.end(), true) - left.begin())};
  std::vector<bool> met(graph.nodes.size(), false);
  while (!met[static_cast<std::size_t>(path.back())]) {
    met[static_cast<std::size_t>(path.back())] = true;
    const auto& needs = graph.nodes[static_cast<std::size_t>(path.back())].needs;
    path.push_back(*std::find_if(needs.begin(), needs.end(), [&](int i) { return left[static_cast<std::size_t>(i)]; }));
  }
  path.erase(path.begin(), std::find(path.begin(), path.end() - 1, path.back()));
  path.pop_back();
  std::rotate(path.begin(), std::min_element(path.begin(), path.end()), path.end());
  return path;
}

void report_cycle(Work& work, const std::vector<int>& cycle) {
  constexpr std::size_t shown = 12;
  const auto named = [&](int i) { return fmt::format("{} (line {})", work.node(i).id, work.node(i).where.line); };
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, cycle.size()); ++i) text += named(cycle[i]) + " needs ";
  if (cycle.size() > shown) text += fmt::format("… {} more … needs ", cycle.size() - shown);
  work.fault(work.node(cycle.front()).where, "tasks that need each other in a circle: " + text + named(cycle.front()));
}

std::vector<int> sorted_order(const Graph& graph) {
  const std::size_t count = graph.nodes.size();
  std::vector<std::vector<int>> users(count);
  std::vector<std::size_t> open(count);
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (std::size_t i = 0; i < count; ++i) {
    open[i] = graph.nodes[i].needs.size();
    for (const int need : graph.nodes[i].needs) users[static_cast<std::size_t>(need)].push_back(static_cast<int>(i));
    if (open[i] == 0) ready.push(static_cast<int>(i));
  }
  std::vector<int> order;
  while (!ready.empty()) {
    const int node = ready.top();
    ready.pop();
    order.push_back(node);
    for (const int user : users[static_cast<std::size_t>(node)])
      if (--open[static_cast<std::size_t>(user)] == 0) ready.push(user);
  }
  return order;
}

/// Files that the tag hands on without reading them.
std::vector<std::filesystem::path> files_as_they_are(const Binding& binding) {
  std::vector<std::filesystem::path> files;
  for (const Source& source : binding.sources)
    if (const auto* value = std::get_if<Value>(&source))
      if (const auto* file = std::get_if<File>(value)) files.push_back(file->path);
  return files;
}

void refuse_overwriting(Work& work) {
  namespace fs = std::filesystem;
  std::error_code code;
  std::set<fs::path> inputs;
  for (const Node& node : work.out.graph.nodes) {
    if (node.kind == NodeKind::file) inputs.insert(fs::weakly_canonical(node.file, code));
    for (const fs::path& file : files_as_they_are(node.args)) inputs.insert(fs::weakly_canonical(file, code));
  }
  const fs::path scene = fs::weakly_canonical(work.document.file, code);
  for (const Node& node : work.out.graph.nodes)
    for (const Target& target : node.targets) {
      const fs::path path = fs::weakly_canonical(work.options.output_folder / target.file, code);
      if (inputs.contains(path))
        work.fault(target.where, fmt::format("{} would overwrite the input of the same name; choose another output "
                                             "folder with -o",
                                             shortened(target.file.string())));
      if (path == scene)
        work.fault(target.where, fmt::format("{} would overwrite the scene itself", shortened(target.file.string())));
    }
}

}  // namespace

void order_nodes(Work& work) {
  Graph& graph = work.out.graph;
  for (Node& node : graph.nodes) {
    if (node.args.description) collect_needs(node.args, node.needs);
    std::sort(node.needs.begin(), node.needs.end());
    node.needs.erase(std::unique(node.needs.begin(), node.needs.end()), node.needs.end());
  }
  graph.order = sorted_order(graph);
  if (graph.order.size() < graph.nodes.size()) report_cycle(work, find_cycle(graph, graph.order));
  refuse_overwriting(work);
}

}  // namespace msml
