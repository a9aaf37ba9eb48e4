// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of elements that different threads may add at the same time.
#pragma once
#include <vector>

namespace msml::fe {

/// A run of consecutive batches [first, last).
struct Chunk {
  int first, last;
};

/// Chunks by colour; two chunks of one colour share no node. `batch_nodes[b]` lists the nodes of batch b (repeats
/// allowed). Depends on the mesh alone, never on the number of threads.
std::vector<std::vector<Chunk>> colour_chunks(const std::vector<std::vector<int>>& batch_nodes, int nodes);

}  // namespace msml::fe
