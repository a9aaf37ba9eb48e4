// SPDX-License-Identifier: GPL-3.0-or-later
// What elements give to their nodes: written by elements, summed by nodes.
#pragma once
#include "solver/elements/element_sums.hpp"

namespace msml::fe {

/// Vectors of the nodes of all elements. Each node sums those of its elements in the order of the elements, whatever
/// thread wrote them.
template <int nodes>
class NodeParts {
 public:
  explicit NodeParts(const Numbering& numbering)
      : first_(static_cast<std::size_t>(numbering.nodes()) + 1, 0),
        places_(numbering.element_nodes.size()),
        parts_(4 * numbering.element_nodes.size()) {
    for (const int node : numbering.element_nodes) ++first_[static_cast<std::size_t>(node) + 1];
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (std::size_t k = 0; k < places_.size(); ++k)
      places_[static_cast<std::size_t>(next[static_cast<std::size_t>(numbering.element_nodes[k])]++)] =
          static_cast<int>(k);
  }

  /// Those of the elements of a batch. From several threads at once for different batches.
  template <class Batch>
  void set(const Batch& batch, const Lanes (&vectors)[nodes][3]) {
    for (int a = 0; a < nodes; a += 2) {
      Lanes rows[lanes];
      pair_vectors(vectors, a, rows);
      for (int lane = 0; lane < batch.count; ++lane)
        std::memcpy(&parts_[4 * static_cast<std::size_t>(nodes * (batch.first + lane) + a)], &rows[lane],
                    sizeof rows[lane]);
    }
  }

  /// Adds the sums of nodes [begin, end) to theirs.
  void add(int begin, int end, Vector& values) const {
    using Four = double __attribute__((vector_size(32)));
    for (int n = begin; n < end; ++n) {
      Four sum{};
      for (int k = first_[static_cast<std::size_t>(n)]; k < first_[static_cast<std::size_t>(n) + 1]; ++k) {
        Four part;
        std::memcpy(&part, &parts_[4 * static_cast<std::size_t>(places_[static_cast<std::size_t>(k)])], sizeof part);
        sum += part;
      }
      for (int i = 0; i < 3; ++i) values[3 * n + i] += sum[i];
    }
  }

  std::size_t bytes() const { return (first_.size() + places_.size()) * sizeof(int) + parts_.size() * sizeof(double); }

 private:
  std::vector<int> first_, places_;  ///< of node n: places_[first_[n] .. first_[n + 1]), in fours of parts_
  Numbers<double> parts_;            ///< three numbers and one more of each node of each element
};

}  // namespace msml::fe
