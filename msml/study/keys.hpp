// SPDX-License-Identifier: GPL-3.0-or-later
// What makes two nodes of two runs the same: operator, settings, and the same nodes before them.
#pragma once
#include <string>
#include <vector>

#include "msml/compile/graph.hpp"

namespace msml {

/// A 128-bit hash of a text as 32 hexadecimal digits (XXH3).
std::string hash(const std::string& text);

/// One key per node: nodes with equal keys give equal outputs. It covers the operator, every value of its attributes,
/// the keys of the nodes that feed it, and of a file its path, size and time of writing.
std::vector<std::string> node_keys(const Graph& graph);

}  // namespace msml
