// SPDX-License-Identifier: GPL-3.0-or-later
// Dependency order, cycles, and outputs that would overwrite inputs.
#include <fmt/format.h>

#include <algorithm>
#include <queue>

#include "msml/compile/work.hpp"

namespace msml {
namespace {

/// Depth-first search for a cycle; `path` holds the nodes on the way.
bool find_cycle(const Graph& graph, int node, std::vector<int>& mark, std::vector<int>& path) {
  mark[static_cast<std::size_t>(node)] = 1;
  path.push_back(node);
  for (const int need : graph.nodes[static_cast<std::size_t>(node)].needs) {
    if (mark[static_cast<std::size_t>(need)] == 1) {
      path.push_back(need);
      return true;
    }
    if (mark[static_cast<std::size_t>(need)] == 0 && find_cycle(graph, need, mark, path)) return true;
  }
  path.pop_back();
  mark[static_cast<std::size_t>(node)] = 2;
  return false;
}

void report_cycle(Work& work, const std::vector<int>& path) {
  const auto start = std::find(path.begin(), path.end() - 1, path.back());
  std::string text;
  for (auto i = start; i != path.end(); ++i)
    text += fmt::format("{}{} (line {})", text.empty() ? "" : " needs ", work.node(*i).id, work.node(*i).where.line);
  work.fault(work.node(path.back()).where, "a cycle: " + text);
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

void refuse_overwriting(Work& work) {
  namespace fs = std::filesystem;
  std::error_code code;
  for (const Node& node : work.out.graph.nodes)
    for (const Target& target : node.targets) {
      const fs::path path = fs::weakly_canonical(work.options.output_folder / target.file, code);
      for (const Node& input : work.out.graph.nodes)
        if (input.kind == NodeKind::file && fs::weakly_canonical(input.file, code) == path)
          work.fault(target.where, fmt::format("{} would overwrite the input of the same name; choose another output "
                                               "folder with -o", target.file.string()));
      if (path == fs::weakly_canonical(work.document.file, code))
        work.fault(target.where, fmt::format("{} would overwrite the scene itself", target.file.string()));
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
  std::vector<int> mark(graph.nodes.size(), 0);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    std::vector<int> path;
    if (mark[i] == 0 && find_cycle(graph, static_cast<int>(i), mark, path)) {
      report_cycle(work, path);
      return;
    }
  }
  graph.order = sorted_order(graph);
  refuse_overwriting(work);
}

}  // namespace msml
