// SPDX-License-Identifier: GPL-3.0-or-later
// What element loops are made of, for eight elements side by side: gather, force, stiffness, scatter.
#pragma once
#include "solver/elements/element_sums.hpp"

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

/// dN_a/dxi of the nodes at one point.
template <int dimension, int nodes>
using ReferenceGradients = std::array<std::array<double, dimension>, nodes>;

/// Displacements of the nodes of eight elements.
template <int dimension, int nodes>
struct NodeValues {
  Lanes u[nodes][dimension];
};
template <int dimension, int nodes, class Batch>
NodeValues<dimension, nodes> gather_nodes(const Batch& batch, const Vector& u) {
  NodeValues<dimension, nodes> values;
  if constexpr (dimension == 3) {
    gather_vectors(batch, u.data(), values.u);
  } else {
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dimension; ++i) values.u[a][i] = gather(batch, a, u.data() + i);
  }
  return values;
}

/// H = sum_a u_a r_a^T dxi/dX, r_a = dN_a/dxi; `inverse` is dxi/dX row by row.
template <int dimension, int nodes>
Gradients displacement_gradient(const NodeValues<dimension, nodes>& values, const Lanes* inverse,
                                const ReferenceGradients<dimension, nodes>& r) {
  Gradients H;
  if constexpr (dimension < 3) H = {};
  for (int i = 0; i < dimension; ++i) {
    Lanes by_xi[dimension];  // row i of du/dxi
    for (std::size_t d = 0; d < dimension; ++d) {
      if constexpr (nodes == dimension + 1) {
        by_xi[d] = values.u[d + 1][i] - values.u[0][i];
      } else {
        by_xi[d] = values.u[0][i] * r[0][d];
        for (std::size_t a = 1; a < nodes; ++a) by_xi[d] += values.u[a][i] * r[a][d];
      }
    }
    for (int k = 0; k < dimension; ++k) {
      H(i, k) = by_xi[0] * inverse[k];
      for (int d = 1; d < dimension; ++d) H(i, k) += by_xi[d] * inverse[dimension * d + k];
    }
  }
  return H;
}

/// force_a += w P (dxi/dX)^T r_a.
template <int dimension, int nodes>
void add_force(const Tensor<Lanes>& P, Lanes w, const Lanes* inverse, const ReferenceGradients<dimension, nodes>& r,
               SimplexResult<dimension, nodes>& result) {
  for (int i = 0; i < dimension; ++i) {
    Lanes by_xi[dimension];
    for (int d = 0; d < dimension; ++d) by_xi[d] = w * inner<dimension>(P.c + 3 * i, inverse + dimension * d);
    for (std::size_t d = 0; d < dimension; ++d) {
      if constexpr (nodes == dimension + 1) {
        result.force[d + 1][i] += by_xi[d];
        result.force[0][i] -= by_xi[d];
      } else {
        for (std::size_t a = 0; a < nodes; ++a) result.force[a][i] += by_xi[d] * r[a][d];
      }
    }
  }
}

template <int dimension, int nodes>
void add_stiffness(const Lanes* A, Lanes w, const SimplexGradients<dimension, nodes>& gradients,
                   SimplexResult<dimension, nodes>& result) {
  add_stiffness<dimension, nodes, nodes*(nodes + 1) / 2>(A, w, gradients.g, result.block);
}

template <int dimension, int nodes, class Batch>
void scatter_force(const Batch& batch, const SimplexResult<dimension, nodes>& result, Vector& force) {
  if constexpr (dimension == 3) return scatter_vectors(batch, result.force, force.data());
  for (int lane = 0; lane < batch.count; ++lane)
    for (int a = 0; a < nodes; ++a) {
      double* f = force.data() + 3 * batch.node[lane][a];
      for (int i = 0; i < dimension; ++i) f[i] += result.force[a][i][lane];
    }
}

template <int dimension, int nodes, class Batch>
void scatter_stiffness(const Batch& batch, const SimplexResult<dimension, nodes>& result, BlockMatrix& matrix) {
  if constexpr (dimension == 3) {
    for (int b = 0; b < nodes; ++b)
      for (int a = 0; a <= b; ++a) {
        const Lanes* block = result.block[packed(b, a)];
        add_blocks<false>(
            block, batch.count, [&](int lane) { return batch.position[lane][a * nodes + b]; }, matrix);
        if (a < b)
          add_blocks<true>(
              block, batch.count, [&](int lane) { return batch.position[lane][b * nodes + a]; }, matrix);
      }
    return;
  }
  for (int lane = 0; lane < batch.count; ++lane)
    for (int b = 0; b < nodes; ++b)
      for (int a = 0; a <= b; ++a) {
        const Lanes* block = result.block[packed(b, a)];
        double* upper = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][a * nodes + b]);
        double* lower = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][b * nodes + a]);
        for (int i = 0; i < dimension; ++i)
          for (int j = 0; j < dimension; ++j) upper[3 * i + j] += block[dimension * i + j][lane];
        if (a == b) continue;
        for (int i = 0; i < dimension; ++i)
          for (int j = 0; j < dimension; ++j) lower[3 * j + i] += block[dimension * i + j][lane];
      }
}

}  // namespace msml::fe
