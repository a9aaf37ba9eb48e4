// SPDX-License-Identifier: GPL-3.0-or-later
// Which nodes run, and in what order.
#pragma once
#include <string>
#include <vector>

#include "msml/compile/graph.hpp"

namespace msml {

struct Plan {
  std::vector<bool> runs;    ///< one per node
  std::vector<int> order;    ///< the nodes that run, each after all it needs
  std::vector<int> skipped;  ///< tasks and simulations that nothing asks for, in place order
};

/// A node runs if a file target, a scene output, a report or one of `requested` (ids of tasks or scene outputs) needs
/// it. Throws Error for a requested id that does not exist.
Plan make_plan(const Graph& graph, const std::vector<std::string>& requested = {});

/// The plan for these nodes and what they need, and nothing else.
Plan plan_for(const Graph& graph, const std::vector<int>& nodes);

/// What exec --dry-run prints: the nodes in order with inputs and targets, then those that do not run.
std::string describe(const Graph& graph, const Plan& plan);

}  // namespace msml
