// SPDX-License-Identifier: GPL-3.0-or-later
// Greedy colouring of chunks of batches.
#include "solver/elements/chunks.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace msml::fe {
namespace {

constexpr int most_colours = 64;

/// Small meshes come in small chunks, so that every colour has several for each thread.
int batches_per_chunk(int batches) { return std::clamp(batches / 128, 1, 32); }

/// Chunks, the colour of each (most_colours: alone), and the colours seen at each node.
class Colouring {
 public:
  Colouring(const std::vector<std::vector<int>>& batch_nodes, int nodes)
      : batch_nodes_(batch_nodes), taken_(static_cast<std::size_t>(nodes), 0), sizes_(most_colours + 1, 0) {
    const int batches = static_cast<int>(batch_nodes.size()), size = batches_per_chunk(batches);
    for (int first = 0; first < batches; first += size) {
      chunks_.push_back({first, std::min(first + size, batches)});
      colours_.push_back(std::countr_one(around(chunks_.back())));
      set(chunks_.size() - 1, colours_.back());
    }
  }

  /// The first free colour leaves next to nothing to the last ones: chunks of large colours go to small ones.
  void level() {
    const int used = static_cast<int>(std::find(sizes_.begin(), sizes_.end(), 0) - sizes_.begin());
    for (std::size_t k = 0; k < chunks_.size(); ++k) {
      const int own = colours_[k];
      if (own == most_colours) continue;
      const std::uint64_t mask = around(chunks_[k]);
      int best = own;
      for (int c = 0; c < std::min(used, most_colours); ++c)
        if ((mask >> c & 1) == 0 && size(c) + 1 < size(best) + (best == own ? 0 : 1)) best = c;
      if (best == own) continue;
      --sizes_[static_cast<std::size_t>(own)];
      for_nodes(chunks_[k], [&](std::uint64_t& colours) { colours &= ~(std::uint64_t(1) << own); });
      set(k, best);
    }
  }

  std::vector<std::vector<Chunk>> by_colour() const {
    std::vector<std::vector<Chunk>> lists(most_colours);
    for (std::size_t k = 0; k < chunks_.size(); ++k) {
      if (colours_[k] < most_colours)
        lists[static_cast<std::size_t>(colours_[k])].push_back(chunks_[k]);
      else
        lists.push_back({chunks_[k]});
    }
    std::erase_if(lists, [](const auto& chunks) { return chunks.empty(); });
    return lists;
  }

 private:
  template <class Body>
  void for_nodes(const Chunk& chunk, const Body& body) {
    for (int b = chunk.first; b < chunk.last; ++b)
      for (const int node : batch_nodes_[static_cast<std::size_t>(b)]) body(taken_[static_cast<std::size_t>(node)]);
  }
  std::uint64_t around(const Chunk& chunk) {
    std::uint64_t mask = 0;
    for_nodes(chunk, [&](std::uint64_t colours) { mask |= colours; });
    return mask;
  }
  void set(std::size_t k, int colour) {
    colours_[k] = colour;
    ++sizes_[static_cast<std::size_t>(colour)];
    if (colour == most_colours) return;
    for_nodes(chunks_[k], [&](std::uint64_t& colours) { colours |= std::uint64_t(1) << colour; });
  }
  int size(int colour) const { return sizes_[static_cast<std::size_t>(colour)]; }

  const std::vector<std::vector<int>>& batch_nodes_;
  std::vector<std::uint64_t> taken_;
  std::vector<int> sizes_;
  std::vector<Chunk> chunks_;
  std::vector<int> colours_;
};

}  // namespace

std::vector<std::vector<Chunk>> colour_chunks(const std::vector<std::vector<int>>& batch_nodes, int nodes) {
  Colouring colouring(batch_nodes, nodes);
  for (int round = 0; round < 3; ++round) colouring.level();
  return colouring.by_colour();
}

}  // namespace msml::fe
