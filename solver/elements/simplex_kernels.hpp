// SPDX-License-Identifier: GPL-3.0-or-later
// What element loops are made of, for eight elements side by side: gather, force, stiffness, scatter.
#pragma once
#include <cstring>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// dN_a/dX of eight elements at one point.
template <int dimension, int nodes>
struct SimplexGradients {
  Lanes g[nodes][dimension];
};

/// Internal force and stiffness of eight elements. Blocks (a, b), a <= b, at b(b+1)/2 + a; dimension x dimension each.
template <int dimension, int nodes>
struct SimplexResult {
  Lanes force[nodes][dimension];
  Lanes block[nodes * (nodes + 1) / 2][dimension * dimension];
};

/// Place of entry (i, j) of a symmetric matrix stored as its lower triangle by rows.
constexpr int packed_entry(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

/// values[3 n] for the nodes a of eight elements.
template <class Batch>
Lanes gather(const Batch& batch, int a, const double* values) {
  alignas(Lanes) double out[lanes];
  for (int lane = 0; lane < lanes; ++lane) out[lane] = values[3 * batch.node[lane][a]];
  Lanes result;
  std::memcpy(&result, out, sizeof result);
  return result;
}

/// a . b of two vectors of `dimension` lanes.
template <int dimension>
Lanes inner(const Lanes* a, const Lanes* b) {
  Lanes sum = a[0] * b[0];
  for (int k = 1; k < dimension; ++k) sum += a[k] * b[k];
  return sum;
}

/// force_a += w P g_a.
template <int dimension, int nodes>
void add_force(const Tensor<Lanes>& P, Lanes w, const SimplexGradients<dimension, nodes>& gradients,
               SimplexResult<dimension, nodes>& result) {
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < dimension; ++i) result.force[a][i] += w * inner<dimension>(P.c + 3 * i, gradients.g[a]);
}

/// block_ab(i, j) += w sum_kl g_a,k A_(ik)(jl) g_b,l.
template <int dimension, int nodes>
void add_stiffness(const Lanes* A, Lanes w, const SimplexGradients<dimension, nodes>& gradients,
                   SimplexResult<dimension, nodes>& result) {
  for (int b = 0; b < nodes; ++b) {
    Lanes scaled[dimension];
    for (int l = 0; l < dimension; ++l) scaled[l] = w * gradients.g[b][l];
    Lanes half[dimension][dimension][dimension];  // A contracted with g_b: i, j, k
    for (int i = 0; i < dimension; ++i)
      for (int k = 0; k < dimension; ++k)
        for (int j = 0; j < dimension; ++j) {
          Lanes sum = A[packed_entry(3 * i + k, 3 * j)] * scaled[0];
          for (int l = 1; l < dimension; ++l) sum += A[packed_entry(3 * i + k, 3 * j + l)] * scaled[l];
          half[i][j][k] = sum;
        }
    for (int a = 0; a <= b; ++a) {
      Lanes* block = result.block[packed_entry(b, a)];
      for (int i = 0; i < dimension; ++i)
        for (int j = 0; j < dimension; ++j) block[dimension * i + j] += inner<dimension>(gradients.g[a], half[i][j]);
    }
  }
}

template <int dimension, int nodes, class Batch>
void scatter_force(const Batch& batch, const SimplexResult<dimension, nodes>& result, Vector& force) {
  for (int lane = 0; lane < batch.count; ++lane)
    for (int a = 0; a < nodes; ++a) {
      double* f = force.data() + 3 * batch.node[lane][a];
      for (int i = 0; i < dimension; ++i) f[i] += result.force[a][i][lane];
    }
}

template <int dimension, int nodes, class Batch>
void scatter_stiffness(const Batch& batch, const SimplexResult<dimension, nodes>& result, BlockMatrix& matrix) {
  for (int lane = 0; lane < batch.count; ++lane)
    for (int b = 0; b < nodes; ++b)
      for (int a = 0; a <= b; ++a) {
        const Lanes* block = result.block[packed_entry(b, a)];
        double* upper = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][a * nodes + b]);
        double* lower = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][b * nodes + a]);
        for (int i = 0; i < dimension; ++i)
          for (int j = 0; j < dimension; ++j) upper[3 * i + j] += block[dimension * i + j][lane];
        if (a == b) continue;
        for (int i = 0; i < dimension; ++i)
          for (int j = 0; j < dimension; ++j) lower[3 * j + i] += block[dimension * i + j][lane];
      }
}

/// Adds what another thread found.
inline void merge(Assembled& sum, const Assembled& part) {
  sum.energy += part.energy;
  sum.finite = sum.finite && part.finite;
  if (part.smallest_J < sum.smallest_J) {
    sum.smallest_J = part.smallest_J;
    sum.smallest_J_element = part.smallest_J_element;
  }
}

}  // namespace msml::fe
