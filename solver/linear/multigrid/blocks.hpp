// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices of small dense blocks, and the products that multigrid needs.
#pragma once
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <vector>

namespace msml::fe {

/// Where the blocks of a sparse matrix are: row r has columns[offsets[r] .. offsets[r + 1]), ascending.
struct Sparsity {
  int width = 0;  ///< number of block columns
  std::vector<int> offsets{0}, columns;
  int rows() const { return static_cast<int>(offsets.size()) - 1; }
};

/// Rows [0, rows) in pieces of a fixed size, in parallel.
template <class Body>
void for_rows(int rows, int piece, const Body& body) {
  if (rows <= piece) {
    for (int r = 0; r < rows; ++r) body(r);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<int>(0, rows, static_cast<std::size_t>(piece)), [&](const auto& range) {
    for (int r = range.begin(); r < range.end(); ++r) body(r);
  });
}

/// R x C blocks. Entry (i, j) of the block at position p is values[R C p + R j + i]: column by column, so that a
/// product adds multiples of columns. A few more numbers behind the last block may be read.
template <class T, int R, int C>
struct Blocks {
  Sparsity sparsity;
  std::vector<T> values;

  static constexpr std::size_t size = R * C;
  void allocate() { values.assign(size * sparsity.columns.size() + 8, T(0)); }
  T* block(int p) { return values.data() + size * static_cast<std::size_t>(p); }
  const T* block(int p) const { return values.data() + size * static_cast<std::size_t>(p); }
  std::size_t bytes() const {
    return values.size() * sizeof(T) + (sparsity.columns.size() + sparsity.offsets.size()) * sizeof(int);
  }
};

/// C = A B.
Sparsity product_sparsity(const Sparsity& A, const Sparsity& B);
Sparsity transposed(const Sparsity& A);

using Single4 = float __attribute__((vector_size(16)));
using Single8 = float __attribute__((vector_size(32)));
/// Holds a column of R <= 8 numbers.
template <int R>
using Column = std::conditional_t<(R <= 4), Single4, Single8>;

/// sum_j += column j of a block times v_j.
template <int R, int C>
void add_product(const float* block, const float* v, Column<R> (&sum)[C]) {
  for (int j = 0; j < C; ++j) {
    Column<R> column;
    std::memcpy(&column, block + R * j, sizeof column);
    sum[j] += column * v[j];
  }
}

/// Row r of A x: R numbers and a few more.
template <int R, int C>
Column<R> row_product(const Blocks<float, R, C>& A, int r, const float* x) {
  Column<R> even[C] = {}, odd[C] = {};  // two sums, so that one need not wait for the other
  const int* columns = A.sparsity.columns.data();
  int p = A.sparsity.offsets[static_cast<std::size_t>(r)];
  const int end = A.sparsity.offsets[static_cast<std::size_t>(r) + 1];
  for (; p + 1 < end; p += 2) {
    add_product<R>(A.block(p), x + C * columns[p], even);
    add_product<R>(A.block(p + 1), x + C * columns[p + 1], odd);
  }
  if (p < end) add_product<R>(A.block(p), x + C * columns[p], even);
  Column<R> sum = even[0] + odd[0];
  for (int j = 1; j < C; ++j) sum += even[j] + odd[j];
  return sum;
}

/// D v for one R x R block.
template <int R>
Column<R> block_product(const float* block, const Column<R>& v) {
  Column<R> sum{};
  for (int j = 0; j < R; ++j) {
    Column<R> column;
    std::memcpy(&column, block + R * j, sizeof column);
    sum += column * v[j];
  }
  return sum;
}

/// C = A B on a sparsity that holds the product; the order of sums depends on the matrices alone.
template <class T, int R, int K, int C>
void multiply(const Blocks<T, R, K>& A, const Blocks<T, K, C>& B, Blocks<T, R, C>& product) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::fill(product.values.begin(), product.values.end(), T(0));
  tbb::enumerable_thread_specific<std::vector<int>> places(
      std::vector<int>(at(std::max(1, product.sparsity.width)), -1));
  const auto row = [&](int r) {
    std::vector<int>& place = places.local();
    for (int p = product.sparsity.offsets[at(r)]; p < product.sparsity.offsets[at(r + 1)]; ++p)
      place[at(product.sparsity.columns[at(p)])] = p;
    for (int p = A.sparsity.offsets[at(r)]; p < A.sparsity.offsets[at(r + 1)]; ++p) {
      const T* a = A.block(p);
      const int k = A.sparsity.columns[at(p)];
      for (int q = B.sparsity.offsets[at(k)]; q < B.sparsity.offsets[at(k + 1)]; ++q) {
        const T* b = B.block(q);
        T* c = product.block(place[at(B.sparsity.columns[at(q)])]);
        for (int j = 0; j < C; ++j)
          for (int m = 0; m < K; ++m)
            for (int i = 0; i < R; ++i) c[R * j + i] += a[R * m + i] * b[K * j + m];
      }
    }
  };
  for_rows(A.sparsity.rows(), 64, row);
}

template <class T, int R, int C>
Blocks<T, C, R> transposed(const Blocks<T, R, C>& A) {
  Blocks<T, C, R> B;
  B.sparsity = transposed(A.sparsity);
  B.allocate();
  std::vector<int> next(B.sparsity.offsets.begin(), B.sparsity.offsets.end() - 1);
  for (int r = 0; r < A.sparsity.rows(); ++r)
    for (int p = A.sparsity.offsets[static_cast<std::size_t>(r)];
         p < A.sparsity.offsets[static_cast<std::size_t>(r) + 1]; ++p) {
      const T* a = A.block(p);
      T* b = B.block(next[static_cast<std::size_t>(A.sparsity.columns[static_cast<std::size_t>(p)])]++);
      for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) b[C * i + j] = a[R * j + i];
    }
  return B;
}

/// The same numbers in single precision.
template <int R, int C>
Blocks<float, R, C> rounded(const Blocks<double, R, C>& A) {
  Blocks<float, R, C> B;
  B.sparsity = A.sparsity;
  B.values.assign(A.values.begin(), A.values.end());
  return B;
}

}  // namespace msml::fe
