// SPDX-License-Identifier: GPL-3.0-or-later
// Bindings with edges -> records with values. Internal to msml/run.
#pragma once
#include <filesystem>
#include <vector>

#include "msml/compile/graph.hpp"

namespace msml {

/// Outputs of the nodes that have run: results[node][slot].
using Results = std::vector<std::vector<Value>>;

/// Fills a binding with values, each converted to its slot's type. Throws Error at the attribute's place.
Record gather(const Graph& graph, const Binding& binding, const Results& results,
              const std::filesystem::path& output_folder);

}  // namespace msml
