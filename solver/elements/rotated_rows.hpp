// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness matrices R K R^T of linear tetrahedra, block by block.
#pragma once
#include <vector>

#include "solver/block_matrix.hpp"

namespace msml::fe {

/// What the stiffness of a linear tetrahedron with Hooke's law, turned by R, is made of: with h_a = sqrt(w mu) R
/// dN_a/dX and the reference volume w its blocks are K_ab = (h_a . h_b) I + h_b h_a^T + (lambda/mu) h_a h_b^T.
struct alignas(64) RotatedTetrahedron {
  double h[4][4] = {};  ///< [a][0..2]; [0][3]: lambda/mu, [1..3][3]: 0
};

/// Adds up such matrices. Each block is summed in registers over the elements around its edge, and written once: faster
/// than adding the blocks of each element to the matrix. The blocks of a row add up to zero, as K moved as a whole has
/// no forces, which gives the diagonal ones.
class RotatedRows {
 public:
  /// `positions`: of block (a, b) of element e in the pattern, at 16 e + 4 a + b.
  RotatedRows(PatternPtr pattern, const std::vector<int>& positions);
  /// matrix = the sum over all elements, symmetric to the last bit.
  void sum(const std::vector<RotatedTetrahedron>& elements, BlockMatrix& matrix) const;
  std::size_t bytes() const { return (first_.size() + parts_.size()) * sizeof(int); }

 private:
  void sum_row(int row, const RotatedTetrahedron* elements, double* out) const;

  PatternPtr pattern_;
  std::vector<int> first_;  ///< parts_[first_[p] .. first_[p + 1]) are those of block p; diagonal blocks have none
  std::vector<int> parts_;  ///< 16 element + 4 a + b; and a few more that are looked at
};

}  // namespace msml::fe
