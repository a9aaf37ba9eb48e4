// SPDX-License-Identifier: GPL-3.0-or-later
// The inner products that every element of solids is made of, eight elements at a time.
#pragma once
#include <tbb/parallel_for.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include <cmath>
#include <cstring>

#include "solver/elements/assembly.hpp"
#include "solver/elements/chunks.hpp"

namespace msml::fe {

/// Place of entry (i, j) of a symmetric matrix in its lower triangle by rows.
constexpr int packed(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

/// values[3 n] for the nodes a of eight elements.
template <class Batch>
Lanes gather(const Batch& batch, int a, const double* values) {
  static_assert(lanes == 8);
  const auto value = [&](int lane) { return values[3 * batch.node[lane][a]]; };
  return Lanes{value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)};
}

/// The vectors values[3 n .. 3 n + 2] of the nodes of eight elements.
template <int nodes, class Batch>
void gather_vectors(const Batch& batch, const double* values, Lanes (&vectors)[nodes][3]) {
  static_assert(nodes % 2 == 0);
#ifdef __AVX512F__
  for (int a = 0; a < nodes; a += 2) {
    Lanes rows[lanes];  // lane by lane: a vector and one number more, twice
    for (int lane = 0; lane < lanes; ++lane) {
      const __m512d one = _mm512_maskz_loadu_pd(0x07, values + 3 * batch.node[lane][a]);
      rows[lane] = Lanes(_mm512_mask_loadu_pd(one, 0x70, values + (3 * batch.node[lane][a + 1] - 4)));
    }
    transpose(rows);
    for (int i = 0; i < 3; ++i) vectors[a][i] = rows[i], vectors[a + 1][i] = rows[4 + i];
  }
#else
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < 3; ++i) vectors[a][i] = gather(batch, a, values + i);
#endif
}

/// Of each of eight elements the vectors a and a + 1 with a number more behind each.
template <int nodes>
void pair_vectors(const Lanes (&vectors)[nodes][3], int a, Lanes (&rows)[lanes]) {
  for (int i = 0; i < 3; ++i) rows[i] = vectors[a][i], rows[4 + i] = vectors[a + 1][i];
  rows[3] = rows[7] = Lanes{};
  transpose(rows);
}

/// Adds such vectors of the first `count` elements to those of their nodes.
template <int nodes, class Batch>
void scatter_vectors(const Batch& batch, const Lanes (&vectors)[nodes][3], double* values) {
  static_assert(nodes % 2 == 0);
  using Two = double __attribute__((vector_size(16)));
  for (int a = 0; a < nodes; a += 2) {
    Lanes rows[lanes];
    pair_vectors(vectors, a, rows);
    for (int lane = 0; lane < batch.count; ++lane)
      for (int s = 0; s < 2; ++s) {
        double* out = values + 3 * batch.node[lane][a + s];
        Two sum;
        std::memcpy(&sum, out, sizeof sum);
        sum += Two{rows[lane][4 * s], rows[lane][4 * s + 1]};
        std::memcpy(out, &sum, sizeof sum);
        out[2] += rows[lane][4 * s + 2];
      }
  }
}

/// a . b of two vectors of `dimension` lanes.
template <int dimension>
Lanes inner(const Lanes* a, const Lanes* b) {
  Lanes sum = a[0] * b[0];
  for (int k = 1; k < dimension; ++k) sum += a[k] * b[k];
  return sum;
}

/// force_a += w P g_a, with g_a = dN_a/dX.
template <int dimension, int nodes>
void add_force(const Tensor<Lanes>& P, Lanes w, const Lanes (&g)[nodes][dimension], Lanes (&force)[nodes][dimension]) {
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < dimension; ++i) force[a][i] += w * inner<dimension>(P.c + 3 * i, g[a]);
}

/// block_ab(i, j) += w sum_kl g_a,k A_(ik)(jl) g_b,l for a <= b, block (a, b) at packed(b, a).
template <int dimension, int nodes, int blocks>
void add_stiffness(const Lanes* A, Lanes w, const Lanes (&g)[nodes][dimension],
                   Lanes (&block)[blocks][dimension * dimension]) {
  for (int b = 0; b < nodes; ++b) {
    Lanes scaled[dimension];
    for (int l = 0; l < dimension; ++l) scaled[l] = w * g[b][l];
    // A contracted with g_b: i, j, k. Unrolled, so that places in A are known to the compiler.
    Lanes half[dimension][dimension][dimension];
#pragma GCC unroll 3
    for (int i = 0; i < dimension; ++i)
#pragma GCC unroll 3
      for (int k = 0; k < dimension; ++k)
#pragma GCC unroll 3
        for (int j = 0; j < dimension; ++j) {
          Lanes sum = A[packed(3 * i + k, 3 * j)] * scaled[0];
          for (int l = 1; l < dimension; ++l) sum += A[packed(3 * i + k, 3 * j + l)] * scaled[l];
          half[i][j][k] = sum;
        }
    for (int a = 0; a <= b; ++a) {
      Lanes own[dimension], sums[dimension * dimension];  // in registers: `out` could be a place of g
      for (int k = 0; k < dimension; ++k) own[k] = g[a][k];
      Lanes* const out = block[packed(b, a)];
      for (int m = 0; m < dimension * dimension; ++m) {
        sums[m] = out[m];
        for (int k = 0; k < dimension; ++k) sums[m] += own[k] * half[m / dimension][m % dimension][k];
      }
      for (int m = 0; m < dimension * dimension; ++m) out[m] = sums[m];
    }
  }
}

/// Adds lane k of a 3 x 3 block, or its transpose, to the block at position(k) of the matrix, for the first `count`
/// lanes: eight numbers at once.
template <bool transpose_block, class Position>
void add_blocks(const Lanes* block, int count, const Position& position, BlockMatrix& matrix) {
  Lanes first[lanes];  // entry by entry, then lane by lane
  for (int k = 0; k < lanes; ++k) first[k] = block[transpose_block ? 3 * (k % 3) + k / 3 : k];
  transpose(first);
  for (int lane = 0; lane < count; ++lane) {
    double* out = matrix.values.data() + 9 * static_cast<std::size_t>(position(lane));
    Lanes sum;
    std::memcpy(&sum, out, sizeof sum);
    sum += first[lane];
    std::memcpy(out, &sum, sizeof sum);
    out[8] += block[8][lane];
  }
}

/// Asks for the blocks that a batch will add to, so that they come while its elements are computed.
template <class Batch>
void fetch_blocks(const Batch& batch, const BlockMatrix& matrix) {
  for (int lane = 0; lane < batch.count; ++lane)
    for (const int position : batch.position[lane]) {
      const double* block = matrix.values.data() + 9 * static_cast<std::size_t>(position);
      __builtin_prefetch(block, 1, 2);
      __builtin_prefetch(block + 8, 1, 2);
    }
}

/// det F of F = I + H.
inline Lanes volume_ratio(const Gradients& H) { return determinant(deformation_gradient(H)); }

/// Notes energies (with the weight) and det F of the first `count` lanes; `elements` are their cell ids.
inline void note(const Lanes& energy, const Lanes& J, int count, const int* elements, Assembled& found) {
  for (int lane = 0; lane < count; ++lane) {
    found.energy += energy[lane];
    if (!std::isfinite(energy[lane]) || !std::isfinite(J[lane])) found.finite = false;
    if (J[lane] < found.smallest_J) {
      found.smallest_J = J[lane];
      found.smallest_J_element = elements[lane];
    }
  }
}

/// The same for many batches: collected lane by lane, told once.
struct Notes {
  Lanes energy{}, J = lanes_of(std::numeric_limits<double>::infinity());
  Lanes sound{};  ///< zero as long as all numbers are finite
  using Places = long long __attribute__((vector_size(sizeof(Lanes))));
  Places first{};  ///< place in Numbering::elements of the batch that the smallest J of a lane is from
  /// Of the batch whose lane 0 is the element at `place`. Unused lanes repeat a used one before them, with weight 0.
  void add(const Lanes& weighted_energy, const Lanes& ratio, int place) {
    energy += weighted_energy;
    first = ratio < J ? Places{} + place : first;
    J = ratio < J ? ratio : J;
    sound += 0.0 * (weighted_energy + ratio);
  }
  /// `elements` are the cell ids of all.
  Assembled tell(const std::vector<int>& elements) const {
    Assembled found;
    for (int lane = 0; lane < lanes; ++lane) {
      found.energy += energy[lane];
      found.finite = found.finite && sound[lane] == 0;
      if (!(J[lane] < found.smallest_J)) continue;
      found.smallest_J = J[lane];
      found.smallest_J_element = elements[static_cast<std::size_t>(first[lane] + lane)];
    }
    return found;
  }
};

/// Adds what another part of the elements gave.
inline void merge(Assembled& sum, const Assembled& part) {
  sum.energy += part.energy;
  sum.finite = sum.finite && part.finite;
  if (part.smallest_J < sum.smallest_J) {
    sum.smallest_J = part.smallest_J;
    sum.smallest_J_element = part.smallest_J_element;
  }
}

/// Calls add(chunk) for every chunk, those of one colour in parallel, and puts together what they found, in an order
/// that does not depend on the number of threads.
template <class Add>
Assembled add_chunks(const std::vector<std::vector<Chunk>>& colours, const Add& add) {
  Assembled sum;
  for (const auto& chunks : colours) {
    std::vector<Assembled> parts(chunks.size());
    tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t c) { parts[c] = add(chunks[c]); });
    for (const Assembled& part : parts) merge(sum, part);
  }
  return sum;
}

/// The same with add(batch) for every batch.
template <class Add>
Assembled add_by_colour(const std::vector<std::vector<Chunk>>& colours, const Add& add) {
  return add_chunks(colours, [&](const Chunk& chunk) {
    Assembled part;
    for (int b = chunk.first; b < chunk.last; ++b) merge(part, add(static_cast<std::size_t>(b)));
    return part;
  });
}

/// Calls body(batch) for every batch, in the same order.
template <class Body>
void for_batches(const std::vector<std::vector<Chunk>>& colours, const Body& body) {
  for (const auto& chunks : colours)
    tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t c) {
      for (int b = chunks[c].first; b < chunks[c].last; ++b) body(static_cast<std::size_t>(b));
    });
}

}  // namespace msml::fe
