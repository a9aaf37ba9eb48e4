// SPDX-License-Identifier: GPL-3.0-or-later
// Greedy colouring of chunks of batches.
#include "solver/elements/chunks.hpp"

#include <bit>
#include <cstdint>

namespace msml::fe {

std::vector<std::vector<Chunk>> colour_chunks(const std::vector<std::vector<int>>& batch_nodes, int nodes) {
  constexpr int batches_per_chunk = 8;
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(nodes), 0);  // colours seen at each node
  std::vector<std::vector<Chunk>> colours;
  std::vector<std::vector<Chunk>> alone;  // beyond 64 colours each chunk is its own
  const int batches = static_cast<int>(batch_nodes.size());
  for (int first = 0; first < batches; first += batches_per_chunk) {
    const Chunk chunk{first, std::min(first + batches_per_chunk, batches)};
    std::uint64_t mask = 0;
    for (int b = chunk.first; b < chunk.last; ++b)
      for (const int node : batch_nodes[static_cast<std::size_t>(b)]) mask |= taken[static_cast<std::size_t>(node)];
    const int colour = std::countr_one(mask);
    if (colour == 64) {
      alone.push_back({chunk});
      continue;
    }
    if (static_cast<std::size_t>(colour) == colours.size()) colours.emplace_back();
    colours[static_cast<std::size_t>(colour)].push_back(chunk);
    for (int b = chunk.first; b < chunk.last; ++b)
      for (const int node : batch_nodes[static_cast<std::size_t>(b)])
        taken[static_cast<std::size_t>(node)] |= std::uint64_t(1) << colour;
  }
  colours.insert(colours.end(), alone.begin(), alone.end());
  return colours;
}

}  // namespace msml::fe
