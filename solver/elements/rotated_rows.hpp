// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness matrices R K R^T of linear tetrahedra, block by block.
#pragma once
#include <vector>

#include "solver/block_matrix.hpp"
#include "solver/materials/lanes.hpp"

namespace msml::fe {

/// What the stiffness of a linear tetrahedron with Hooke's law, turned by R, is made of: with the reference volume w
/// and the gradients g_a of the shape functions, h_a = sqrt(w mu) R g_a. With D_ab = h_a h_b^T its blocks are K_ab =
/// D_ab^T
/// + (lambda/mu) D_ab + tr(D_ab) I.
struct alignas(64) RotatedTetrahedron {
  double h[4][4] = {};  ///< [a][0..2]; [a][3]: lambda/mu
};

/// Adds up such matrices. Each block is summed in registers over the elements around its edge, and written once: faster
/// than adding the blocks of each element to the matrix. The blocks of a row add up to zero, as K moved as a whole has
/// no forces, which gives the diagonal ones.
class RotatedRows {
 public:
  /// True if so many elements can be counted.
  static constexpr bool serves(std::size_t elements) { return elements < (std::size_t(1) << 32) / stride; }
  /// `positions`: of block (a, b) of element e in the pattern, at 16 e + 4 a + b.
  RotatedRows(PatternPtr pattern, const std::vector<int>& positions);
  /// Sets `count` elements from `first` on: their rotations, w mu, lambda/mu and gradients. From several threads at
  /// once for different elements.
  void set(int first, int count, const Tensor<Lanes>& R, Lanes stiffness, Lanes ratio, const Lanes (&gradients)[4][3]);
  /// matrix = the sum over all elements, symmetric to the last bit.
  void sum(BlockMatrix& matrix) const;
  std::size_t bytes() const {
    return (first_.size() + parts_.size()) * sizeof(int) + elements_.size() * sizeof(elements_[0]);
  }

 private:
  static constexpr unsigned stride = 64;  ///< of elements in parts_
  void sum_row(int row, double* out) const;

  PatternPtr pattern_;
  std::vector<RotatedTetrahedron> elements_;
  std::vector<int> first_;       ///< parts_[first_[p] .. first_[p + 1]) are those of block p; diagonal blocks have none
  std::vector<unsigned> parts_;  ///< stride element + 16 a + b; and a few more that are looked at
};

/// Matrices that elements add to one by one before rows take over: rows take room that is free once the first linear
/// solution is set up, and pay off in many time steps.
inline constexpr int matrices_before_rows = 2;

/// The positions that RotatedRows wants, of elements in batches.
template <class Batches>
std::vector<int> positions_of_blocks(const Batches& batches) {
  std::size_t elements = 0;
  for (const auto& batch : batches) elements += static_cast<std::size_t>(batch.count);
  std::vector<int> positions;
  positions.reserve(16 * elements);
  for (const auto& batch : batches)
    for (int lane = 0; lane < batch.count; ++lane)
      positions.insert(positions.end(), std::begin(batch.position[lane]), std::end(batch.position[lane]));
  return positions;
}

}  // namespace msml::fe
