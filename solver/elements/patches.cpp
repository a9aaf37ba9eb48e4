// SPDX-License-Identifier: GPL-3.0-or-later
// Greedy grouping of tetrahedra around shared nodes.
#include "solver/elements/patches.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace msml::fe {
namespace {

using Neighbours = std::vector<std::array<int, 4>>;

/// For each element those behind its faces, of the same region; -1 without.
Neighbours neighbours(const Numbering& numbering) {
  struct Side {
    std::array<int, 3> nodes;
    int element, face;
  };
  std::vector<Side> sides;
  const int count = static_cast<int>(numbering.elements.size());
  for (int e = 0; e < count; ++e)
    for (int face = 0; face < 4; ++face) {
      Side side{{}, e, face};
      for (int a = 0, k = 0; a < 4; ++a)
        if (a != face)
          side.nodes[static_cast<std::size_t>(k++)] = numbering.element_nodes[static_cast<std::size_t>(4 * e + a)];
      std::sort(side.nodes.begin(), side.nodes.end());
      sides.push_back(side);
    }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.nodes < b.nodes; });
  Neighbours found(static_cast<std::size_t>(count), {-1, -1, -1, -1});
  const auto region = [&](const Side& side) { return numbering.region_of[static_cast<std::size_t>(side.element)]; };
  for (std::size_t k = 0; k + 1 < sides.size(); ++k) {
    const Side &a = sides[k], &b = sides[k + 1];
    if (a.nodes != b.nodes || region(a) != region(b)) continue;
    found[static_cast<std::size_t>(a.element)][static_cast<std::size_t>(a.face)] = b.element;
    found[static_cast<std::size_t>(b.element)][static_cast<std::size_t>(b.face)] = a.element;
  }
  return found;
}

/// Elements in the order in which they are met through faces, from the first cell of the mesh on: it knows nothing of
/// where the body lies or how its nodes are numbered.
std::vector<int> breadth_first(const Numbering& numbering, const Neighbours& neighbours) {
  std::vector<int> by_cell(numbering.elements.size()), order;
  std::iota(by_cell.begin(), by_cell.end(), 0);
  std::sort(by_cell.begin(), by_cell.end(), [&](int a, int b) {
    return numbering.elements[static_cast<std::size_t>(a)] < numbering.elements[static_cast<std::size_t>(b)];
  });
  std::vector<char> met(by_cell.size(), 0);
  const auto meet = [&](int e) {
    if (e >= 0 && !std::exchange(met[static_cast<std::size_t>(e)], 1)) order.push_back(e);
  };
  std::size_t next = 0;
  for (const int seed : by_cell)
    for (meet(seed); next < order.size(); ++next)
      for (const int e : neighbours[static_cast<std::size_t>(order[next])]) meet(e);
  return order;
}

class Grouping {
 public:
  Grouping(const Numbering& numbering, int size)
      : numbering_(numbering),
        size_(size),
        neighbours_(neighbours(numbering)),
        order_(breadth_first(numbering, neighbours_)),
        rank_(order_.size()),
        patch_of_(numbering.elements.size(), -1) {
    for (std::size_t k = 0; k < order_.size(); ++k) rank_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
  }

  std::vector<std::vector<int>> run() {
    for (const int e : order_)
      if (patch_of_[static_cast<std::size_t>(e)] < 0) grow(e);
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (2 * static_cast<int>(patches_[p].size()) < size_) join(p);
    std::erase_if(patches_, [](const std::vector<int>& patch) { return patch.empty(); });
    return patches_;
  }

 private:
  void grow(int seed) {
    const int id = static_cast<int>(patches_.size());
    std::vector<int> patch, nodes, candidates{seed};
    while (!candidates.empty() && static_cast<int>(patch.size()) < size_) {
      const auto shared = [&](int e) {
        const auto first = numbering_.element_nodes.begin() + 4 * e;
        return std::count_if(first, first + 4,
                             [&](int n) { return std::find(nodes.begin(), nodes.end(), n) != nodes.end(); });
      };
      const auto best = std::max_element(candidates.begin(), candidates.end(), [&](int a, int b) {
        const auto one = shared(a), two = shared(b);
        return one != two ? one < two : rank_[static_cast<std::size_t>(a)] > rank_[static_cast<std::size_t>(b)];
      });
      const int e = *best;
      candidates.erase(best);
      patch.push_back(e);
      patch_of_[static_cast<std::size_t>(e)] = id;
      nodes.insert(nodes.end(), numbering_.element_nodes.begin() + 4 * e, numbering_.element_nodes.begin() + 4 * e + 4);
      for (const int next : neighbours_[static_cast<std::size_t>(e)])
        if (next >= 0 && patch_of_[static_cast<std::size_t>(next)] < 0 &&
            std::find(candidates.begin(), candidates.end(), next) == candidates.end())
          candidates.push_back(next);
    }
    patches_.push_back(patch);
  }

  void join(std::size_t p) {
    std::map<int, int> faces;  // common faces with other patches
    for (const int e : patches_[p])
      for (const int next : neighbours_[static_cast<std::size_t>(e)])
        if (next >= 0 && patch_of_[static_cast<std::size_t>(next)] != static_cast<int>(p))
          ++faces[patch_of_[static_cast<std::size_t>(next)]];
    int best = -1;
    for (const auto& [other, count] : faces)
      if (patches_[static_cast<std::size_t>(other)].size() + patches_[p].size() <= patch_limit &&
          (best < 0 || count > faces[best]))
        best = other;
    if (best < 0) return;
    for (const int e : patches_[p]) {
      patch_of_[static_cast<std::size_t>(e)] = best;
      patches_[static_cast<std::size_t>(best)].push_back(e);
    }
    patches_[p].clear();
  }

  const Numbering& numbering_;
  int size_;
  Neighbours neighbours_;
  std::vector<int> order_, rank_;  ///< elements as they are met, and the place of each
  std::vector<int> patch_of_;
  std::vector<std::vector<int>> patches_;
};

}  // namespace

std::vector<std::vector<int>> make_patches(const Numbering& numbering, int size) {
  return Grouping(numbering, size).run();
}

}  // namespace msml::fe
