// SPDX-License-Identifier: GPL-3.0-or-later
// One node: gather, call, write its targets. Internal to msml/run.
#pragma once
#include "msml/run/gather.hpp"
#include "msml/run/run.hpp"

namespace msml {

/// Runs node `index` with the results of the nodes it needs and returns its outputs. Throws Error with the node's
/// place and name. Fills what the report knows besides time and memory.
std::vector<Value> run_node(const Graph& graph, int index, const Results& results, const Registry& registry,
                            const RunOptions& options, Watcher& watcher, NodeReport& report);

}  // namespace msml
