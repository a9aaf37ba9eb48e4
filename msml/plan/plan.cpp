// SPDX-License-Identifier: GPL-3.0-or-later
// From what is wanted back to what must run.
#include "msml/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "msml/core/error.hpp"

namespace msml {
namespace {

bool named(const Node& node, const std::string& id) {
  return node.id == id || std::find(node.results.begin(), node.results.end(), id) != node.results.end();
}

bool wanted(const Node& node, const std::vector<std::string>& requested) {
  if (!node.targets.empty() || !node.results.empty()) return true;
  if (node.op && node.op->is_report()) return true;
  return std::any_of(requested.begin(), requested.end(), [&](const std::string& id) { return named(node, id); });
}

void check_requests(const Graph& graph, const std::vector<std::string>& requested) {
  std::vector<std::string> ids;
  for (const Node& node : graph.nodes) {
    if (node.kind != NodeKind::file) ids.push_back(node.id);
    ids.insert(ids.end(), node.results.begin(), node.results.end());
  }
  for (const std::string& id : requested)
    if (std::none_of(graph.nodes.begin(), graph.nodes.end(), [&](const Node& node) { return named(node, id); }))
      throw Error(
          fmt::format("--request {}: the scene has no task or output of that name{}", id, did_you_mean(id, ids)),
          {graph.scene, 0});
}

void mark(const Graph& graph, int node, std::vector<bool>& runs) {
  std::vector<int> open{node};
  while (!open.empty()) {
    const auto i = static_cast<std::size_t>(open.back());
    open.pop_back();
    if (runs[i]) continue;
    runs[i] = true;
    open.insert(open.end(), graph.nodes[i].needs.begin(), graph.nodes[i].needs.end());
  }
}

/// From the nodes that run: their order, and those that do not run.
void finish(const Graph& graph, Plan& plan) {
  for (const int node : graph.order)
    if (plan.runs[static_cast<std::size_t>(node)]) plan.order.push_back(node);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (!plan.runs[i] && graph.nodes[i].kind != NodeKind::file) plan.skipped.push_back(static_cast<int>(i));
}

std::string inputs(const Graph& graph, const Node& node) {
  std::string text;
  for (const int need : node.needs) text += (text.empty() ? "" : ", ") + graph.nodes[static_cast<std::size_t>(need)].id;
  return text;
}

std::string results(const Node& node) {
  std::string text;
  for (const Target& target : node.targets) text += (text.empty() ? "" : ", ") + target.file.string();
  for (const std::string& id : node.results) text += (text.empty() ? "" : ", ") + id + "_*.vtu";
  return text;
}

}  // namespace

Plan plan_for(const Graph& graph, const std::vector<int>& nodes) {
  Plan plan;
  plan.runs.assign(graph.nodes.size(), false);
  for (const int node : nodes) mark(graph, node, plan.runs);
  finish(graph, plan);
  return plan;
}

Plan make_plan(const Graph& graph, const std::vector<std::string>& requested) {
  check_requests(graph, requested);
  Plan plan;
  plan.runs.assign(graph.nodes.size(), false);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (wanted(graph.nodes[i], requested)) mark(graph, static_cast<int>(i), plan.runs);
  finish(graph, plan);
  return plan;
}

std::string describe(const Graph& graph, const Plan& plan) {
  std::string text;
  std::size_t tag = 4, id = 4;
  for (const int i : plan.order) {
    tag = std::max(tag, graph.nodes[static_cast<std::size_t>(i)].tag().size());
    id = std::max(id, graph.nodes[static_cast<std::size_t>(i)].id.size());
  }
  int number = 0;
  for (const int i : plan.order) {
    const Node& node = graph.nodes[static_cast<std::size_t>(i)];
    text += fmt::format("[{}/{}] {:<{}}  {:<{}}", ++number, plan.order.size(), node.tag(), tag, node.id, id);
    if (const std::string from = inputs(graph, node); !from.empty()) text += "  from " + from;
    if (const std::string to = results(node); !to.empty()) text += "  writes " + to;
    text += "\n";
  }
  for (const int i : plan.skipped) {
    const Node& node = graph.nodes[static_cast<std::size_t>(i)];
    text += fmt::format("does not run: {} {} (line {}): no output, file target or request needs it\n", node.tag(),
                        node.id, node.where.line);
  }
  return text;
}

}  // namespace msml
