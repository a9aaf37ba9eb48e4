// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices of small dense blocks, and the products that multigrid needs.
#pragma once
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <vector>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "solver/numbers.hpp"

namespace msml::fe {

/// Where the blocks of a sparse matrix are: row r has columns[offsets[r] .. offsets[r + 1]), ascending.
struct Sparsity {
  int width = 0;  ///< number of block columns
  std::vector<int> offsets{0}, columns;
  int rows() const { return static_cast<int>(offsets.size()) - 1; }
};

/// The same of a matrix that someone else holds.
struct SparsityView {
  const std::vector<int>& offsets;
  const std::vector<int>& columns;
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
  Numbers<T> values;

  static constexpr std::size_t size = R * C;
  SparsityView view() const { return {sparsity.offsets, sparsity.columns}; }
  void allocate() { set_zero(values, size * sparsity.columns.size() + 8); }
  T* block(int p) { return values.data() + size * static_cast<std::size_t>(p); }
  const T* block(int p) const { return values.data() + size * static_cast<std::size_t>(p); }
  /// The block at position p of any row.
  void copy(int p, int /*row*/, double* out) const { std::copy_n(block(p), size, out); }
  /// Rows whose product is work for about ten microseconds.
  int piece() const {
    const std::size_t numbers = size * sparsity.columns.size() + 1;
    return std::clamp(static_cast<int>(32768 * static_cast<std::size_t>(sparsity.rows()) / numbers), 8, 1024);
  }
  /// Gives the numbers back.
  void forget_values() { Numbers<T>().swap(values); }
  std::size_t bytes() const {
    return values.size() * sizeof(T) + (sparsity.columns.size() + sparsity.offsets.size()) * sizeof(int);
  }
};

/// C = A B.
Sparsity product_sparsity(const SparsityView& A, const Sparsity& B);
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

#ifdef __AVX512F__
/// Of three numbers the first three times, then the second and the third, as the entries of a 3 x 3 block want them.
inline __m512 spread_columns(const float* v) {
  const __m512i entry = _mm512_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3);
  return _mm512_permutexvar_ps(entry, _mm512_broadcast_f32x4(_mm_loadu_ps(v)));
}

// Masks of all lanes, as the plain forms make GCC 12 warn of registers that nobody reads.
/// The sum of the three columns of what times(p, sum) adds up over the blocks p of a row.
template <class Times>
Single4 sum_of_columns(const Sparsity& sparsity, int r, const Times& times) {
  __m512 even = _mm512_setzero_ps(), odd = even;  // two sums, so that one need not wait for the other
  int p = sparsity.offsets[static_cast<std::size_t>(r)];
  const int end = sparsity.offsets[static_cast<std::size_t>(r) + 1];
  for (; p + 1 < end; p += 2) even = times(p, even), odd = times(p + 1, odd);
  if (p < end) even = times(p, even);
  const __m512i three = _mm512_setr_epi32(3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 0, 0, 0);
  const __m512 sum = _mm512_add_ps(even, odd), next = _mm512_maskz_permutexvar_ps(0xffff, three, sum);
  return _mm512_maskz_extractf32x4_ps(
      0xf, _mm512_add_ps(_mm512_add_ps(sum, next), _mm512_maskz_permutexvar_ps(0xffff, three, next)), 0);
}

/// Row r of A x with the nine numbers of a block in one register; the same as row_product but for round-off.
inline Single4 wide_row_product(const Blocks<float, 3, 3>& A, int r, const float* x) {
  return sum_of_columns(A.sparsity, r, [&](int p, __m512 sum) {
    const __m512 v = spread_columns(x + 3 * A.sparsity.columns[static_cast<std::size_t>(p)]);
    return _mm512_fmadd_ps(_mm512_loadu_ps(A.block(p)), v, sum);
  });
}
#endif

/// Row r of A x: R numbers and a few more.
template <int R, int C>
Column<R> row_product(const Blocks<float, R, C>& A, int r, const float* x) {
#ifdef __AVX512F__
  if constexpr (R == 3 && C == 3) return wide_row_product(A, r, x);
#endif
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

/// Adds row r of A B to blocks at out: the one in column c is block number place[c]. A is Blocks, or a view that copies
/// blocks of R x K numbers.
template <int R, class Left, class T, int K, int C>
void add_row(const Left& A, int r, const Blocks<T, K, C>& B, const std::vector<int>& place, double* out) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const SparsityView left = A.view();
  for (int p = left.offsets[at(r)]; p < left.offsets[at(r + 1)]; ++p) {
    double a[R * K];
    A.copy(p, r, a);
    const int k = left.columns[at(p)];
    for (int q = B.sparsity.offsets[at(k)]; q < B.sparsity.offsets[at(k + 1)]; ++q) {
      const T* b = B.block(q);
      double* c = out + static_cast<std::size_t>(R * C) * at(place[at(B.sparsity.columns[at(q)])]);
      for (int j = 0; j < C; ++j)
        for (int m = 0; m < K; ++m)
          for (int i = 0; i < R; ++i) c[R * j + i] += a[R * m + i] * b[K * j + m];
    }
  }
}

/// Room in each thread to note where the columns of a row are.
using Places = tbb::enumerable_thread_specific<std::vector<int>>;
inline Places places_of(const Sparsity& sparsity) {
  return Places(std::vector<int>(static_cast<std::size_t>(std::max(1, sparsity.width)), -1));
}
/// place[c] = the number of the block in column c among those of row r, from `first` on.
inline void note_places(const Sparsity& sparsity, int r, int first, std::vector<int>& place) {
  for (int p = sparsity.offsets[static_cast<std::size_t>(r)]; p < sparsity.offsets[static_cast<std::size_t>(r) + 1];
       ++p)
    place[static_cast<std::size_t>(sparsity.columns[static_cast<std::size_t>(p)])] = first++;
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

}  // namespace msml::fe
