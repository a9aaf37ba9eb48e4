// SPDX-License-Identifier: GPL-3.0-or-later
// From quadratic elements to linear ones on the same mesh.
#pragma once
#include "solver/linear/multigrid/free_blocks.hpp"
#include "solver/linear/node_geometry.hpp"

namespace msml::fe {

/// Functions that are linear along the edges of quadratic elements: a mid node takes the mean of the ends of its edge.
class Corners {
 public:
  /// `fixed`: 3 per node; those unknowns take no part.
  Corners(const NodeGeometry& geometry, const std::vector<char>& fixed);
  int count() const { return static_cast<int>(node_of_.size()); }
  const std::vector<int>& node_of() const { return node_of_; }      ///< the node that a corner is
  const std::vector<char>& fixed() const { return fixed_coarse_; }  ///< 3 per corner
  /// coarse = P^T A P, with a unit diagonal at fixed unknowns. The sparsity is made once.
  void restrict_matrix(const FreeBlocks& A, Blocks<double, 3, 3>& coarse) const;
  /// P as blocks, in which mid nodes may take from all corners that they are coupled to in a matrix. Nodes of A: those
  /// of the geometry.
  Blocks<float, 3, 3> wide(const SparsityView& A) const;
  void restrict_vector(const std::vector<float>& fine, std::vector<float>& coarse) const;  ///< P^T
  void add_prolonged(const std::vector<float>& coarse, std::vector<float>& fine) const;    ///< fine += P coarse
  std::size_t bytes() const {
    return (node_of_.size() + child_offsets_.size() + children_.size() + 2 * parents_.size()) * sizeof(int) +
           fixed_.size() + fixed_coarse_.size();
  }

 private:
  struct Parents {
    int first, second;  ///< corners; equal for a corner itself
  };
  std::vector<int> node_of_;
  std::vector<Parents> parents_;               ///< of each node
  std::vector<int> child_offsets_, children_;  ///< nodes that a corner has a share in
  std::vector<char> fixed_, fixed_coarse_;
};

}  // namespace msml::fe
