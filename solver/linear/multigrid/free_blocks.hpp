// SPDX-License-Identifier: GPL-3.0-or-later
// The free part of a block matrix, read block by block.
#pragma once
#include "solver/linear/linear_system.hpp"
#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

/// A view: rows and columns of fixed unknowns are zero, but for a unit diagonal.
struct FreeBlocks {
  const BlockMatrix& matrix;
  const Mask& fixed;

  Sparsity sparsity() const { return {matrix.pattern->nodes(), matrix.pattern->offsets, matrix.pattern->columns}; }
  /// The block at position p, in row r and column c, column by column.
  void copy(int p, int r, int c, double* out) const {
    const double* a = matrix.values.data() + 9 * static_cast<std::size_t>(p);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const bool gone = fixed[static_cast<std::size_t>(3 * r + i)] || fixed[static_cast<std::size_t>(3 * c + j)];
        out[3 * j + i] = !gone ? a[3 * i + j] : (r == c && i == j ? 1.0 : 0.0);
      }
  }
};

}  // namespace msml::fe
