// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices of small blocks in single precision.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "solver/linear/multigrid/blocks.hpp"
#include "solver/linear/multigrid/coarsest.hpp"

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

/// A chain of blocks M + M^T + 2 B I with neighbours -I, M of random numbers between -1 and 1.
template <int B>
Blocks<double, B, B> random_chain(int rows) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1, 1);
  Blocks<double, B, B> A;
  A.sparsity.width = rows;
  std::vector<Eigen::Matrix<double, B, B>> blocks;
  for (int r = 0; r < rows; ++r) {
    for (int c = std::max(0, r - 1); c <= std::min(rows - 1, r + 1); ++c) {
      A.sparsity.columns.push_back(c);
      Eigen::Matrix<double, B, B> block = -Eigen::Matrix<double, B, B>::Identity();
      if (c == r) {
        const auto M = Eigen::Matrix<double, B, B>::NullaryExpr([&] { return number(random); }).eval();
        block = M + M.transpose() + 2 * B * Eigen::Matrix<double, B, B>::Identity();
      }
      blocks.push_back(block);
    }
    A.sparsity.offsets.push_back(static_cast<int>(A.sparsity.columns.size()));
  }
  A.allocate();
  for (std::size_t p = 0; p < blocks.size(); ++p) std::copy_n(blocks[p].data(), B * B, A.block(static_cast<int>(p)));
  return A;
}

/// |b - A x| / |b| of the coarsest grid, for a random b.
template <int B>
double rest_of_coarsest(int rows) {
  const Blocks<double, B, B> A = random_chain<B>(rows);
  Coarsest coarsest;
  if (!coarsest.set(A)) return INFINITY;
  std::mt19937 random(3);
  std::vector<float> b(static_cast<std::size_t>(B * rows)), x(b.size());
  for (float& entry : b) entry = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
  coarsest.solve(b, x);
  double rest = 0, size = 0;
  for (int r = 0; r < rows; ++r) {
    Eigen::Matrix<double, B, 1> sum =
        Eigen::Map<const Eigen::Matrix<float, B, 1>>(&b[static_cast<std::size_t>(B * r)]).template cast<double>();
    size += sum.squaredNorm();
    for (int p = A.sparsity.offsets[static_cast<std::size_t>(r)];
         p < A.sparsity.offsets[static_cast<std::size_t>(r) + 1]; ++p)
      sum -= Eigen::Map<const Eigen::Matrix<double, B, B>>(A.block(p)) *
             Eigen::Map<const Eigen::Matrix<float, B, 1>>(
                 &x[static_cast<std::size_t>(B * A.sparsity.columns[static_cast<std::size_t>(p)])])
                 .template cast<double>();
    rest += sum.squaredNorm();
  }
  return std::sqrt(rest / size);
}

// The inverse is made 64 columns at a time; a condition number below 10 leaves ten times round-off of single precision.
TEST(MultigridBlocks, TheCoarsestGridIsSolvedExactly) {
  for (const int rows : {1, 10, 11, 22, 43, 100}) {
    EXPECT_LT(rest_of_coarsest<3>(rows), 6e-7) << rows;
    EXPECT_LT(rest_of_coarsest<6>(rows), 6e-7) << rows;
  }
}

}  // namespace
}  // namespace msml::fe
