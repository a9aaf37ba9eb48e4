// SPDX-License-Identifier: GPL-3.0-or-later
// The free part of a block matrix, read block by block.
#pragma once
#include "solver/linear/linear_system.hpp"
#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

/// A view: rows and columns of fixed unknowns are zero, but for the diagonal, which is kept where it is positive.
class FreeBlocks {
 public:
  FreeBlocks(const BlockMatrix& A, const Mask& mask) : matrix(A), fixed(mask) {}
  const BlockMatrix& matrix;
  const Mask& fixed;

  SparsityView view() const { return {matrix.pattern->offsets, matrix.pattern->columns}; }
  /// The block at position p, in row r, column by column.
  void copy(int p, int r, double* out) const {
    const double* a = matrix.values.data() + 9 * static_cast<std::size_t>(p);
    const int c = matrix.pattern->columns[static_cast<std::size_t>(p)];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out[3 * j + i] = a[3 * i + j];
    if (!held(r) && !held(c)) return;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (fixed[static_cast<std::size_t>(3 * r + i)] || fixed[static_cast<std::size_t>(3 * c + j)])
          out[3 * j + i] = r != c || i != j ? 0.0 : a[4 * i] > 0 ? a[4 * i] : 1.0;
  }

 private:
  bool held(int node) const {
    const char* mask = fixed.data() + 3 * static_cast<std::size_t>(node);
    return mask[0] || mask[1] || mask[2];
  }
};

}  // namespace msml::fe
