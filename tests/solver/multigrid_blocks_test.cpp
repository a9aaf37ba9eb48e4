// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices of small blocks in single precision.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {
namespace {

/// Rows of 0 to 6 blocks of random numbers between -1 and 1.
template <int R, int C>
Blocks<float, R, C> random_blocks(int rows, int width, std::mt19937& random) {
  std::uniform_real_distribution<float> number(-1, 1);
  Blocks<float, R, C> A;
  A.sparsity.width = width;
  for (int r = 0; r < rows; ++r) {
    for (int k = 0; k < r % 7; ++k) A.sparsity.columns.push_back((r + 5 * k) % width);
    A.sparsity.offsets.push_back(static_cast<int>(A.sparsity.columns.size()));
  }
  A.allocate();
  for (std::size_t k = 0; k < R * C * A.sparsity.columns.size(); ++k) A.values[k] = number(random);
  return A;
}

/// The largest difference between products of rows and the same sums in double precision, number by number.
template <int R, int C>
double largest_difference() {
  std::mt19937 random(1);
  const int rows = 50, width = 40;
  const Blocks<float, R, C> A = random_blocks<R, C>(rows, width, random);
  std::vector<float> x(C * width + 8, NAN);  // what follows the vector must not count
  for (std::size_t k = 0; k < C * width; ++k) x[k] = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
  double largest = 0;
  for (int r = 0; r < rows; ++r) {
    double sum[R] = {};
    for (int p = A.sparsity.offsets[static_cast<std::size_t>(r)];
         p < A.sparsity.offsets[static_cast<std::size_t>(r) + 1]; ++p)
      for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j)
          sum[i] +=
              static_cast<double>(A.block(p)[R * j + i]) *
              static_cast<double>(x[static_cast<std::size_t>(C * A.sparsity.columns[static_cast<std::size_t>(p)] + j)]);
    const auto product = row_product(A, r, x.data());
    for (int i = 0; i < R; ++i) largest = std::max(largest, std::abs(sum[i] - static_cast<double>(product[i])));
  }
  return largest;
}

// Up to 36 products of numbers below 1: round-off of single precision, 6e-8, times the sum of their sizes.
TEST(MultigridBlocks, ProductsOfRowsAreThoseOfTheirNumbers) {
  EXPECT_LT((largest_difference<3, 3>()), 2e-6);
  EXPECT_LT((largest_difference<3, 6>()), 2e-6);
  EXPECT_LT((largest_difference<6, 3>()), 2e-6);
  EXPECT_LT((largest_difference<6, 6>()), 2e-6);
}

}  // namespace
}  // namespace msml::fe
