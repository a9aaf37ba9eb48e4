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

/// du_i/dxi_d at the corners of a quadratic simplex, in which it is linear; one value where it is constant.
template <int dimension, int nodes>
struct Slopes {
  static constexpr int places = nodes == dimension + 1 ? 1 : dimension + 1;
  Lanes at[places][dimension][dimension];
};

/// L_c of the corners at one point.
template <int dimension>
using Barycentric = std::array<double, dimension + 1>;

/// Mid node of each pair of corners of a quadratic simplex.
template <int dimension, int nodes>
constexpr auto mid_nodes = [] {
  std::array<std::array<int, dimension + 1>, dimension + 1> mid{};
  for (int k = dimension + 1; k < nodes; ++k) {
    const auto [i, j] = Simplex<dimension, nodes>::edges[static_cast<std::size_t>(k - dimension - 1)];
    mid[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = k;
    mid[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = k;
  }
  return mid;
}();

/// du/dxi. Of quadratic simplices it is linear, and at corner c the slope towards corner j is 4 u_cj - 3 u_c - u_j with
/// the node cj between them: fewer operations than the gradients of all shape functions at each point.
template <int dimension, int nodes>
Slopes<dimension, nodes> slopes(const NodeValues<dimension, nodes>& values) {
  Slopes<dimension, nodes> D;
  for (int i = 0; i < dimension; ++i) {
    if constexpr (nodes == dimension + 1) {
      for (int d = 0; d < dimension; ++d) D.at[0][i][d] = values.u[d + 1][i] - values.u[0][i];
    } else {
      for (std::size_t c = 0; c <= dimension; ++c) {
        const Lanes own = 3.0 * values.u[c][i];
        const auto towards = [&](std::size_t j) {
          return 4.0 * values.u[mid_nodes<dimension, nodes>[c][j]][i] - values.u[j][i] - own;
        };
        // Axis d leads from corner 0 to corner d + 1, and so from corner c to d + 1 and back from c to 0.
        const Lanes back = c == 0 ? Lanes{} : towards(0);
        for (std::size_t d = 0; d < dimension; ++d)
          D.at[c][i][d] = c == 0 ? towards(d + 1) : d + 1 == c ? -back : towards(d + 1) - back;
      }
    }
  }
  return D;
}

/// H = du/dxi dxi/dX; `inverse` is dxi/dX row by row.
template <int dimension, int nodes>
void displacement_gradient(const Slopes<dimension, nodes>& D, const Lanes* inverse, const Barycentric<dimension>& L,
                           Gradients& H) {
  if constexpr (dimension < 3) H = {};
  for (int i = 0; i < dimension; ++i) {
    Lanes by_xi[dimension];  // row i of du/dxi
    for (int d = 0; d < dimension; ++d) {
      by_xi[d] = D.at[0][i][d];
      if constexpr (nodes > dimension + 1) {
        by_xi[d] *= L[0];
        for (std::size_t c = 1; c <= dimension; ++c) by_xi[d] += L[c] * D.at[c][i][d];
      }
    }
    for (int k = 0; k < dimension; ++k) {
      H(i, k) = by_xi[0] * inverse[k];
      for (int d = 1; d < dimension; ++d) H(i, k) += by_xi[d] * inverse[dimension * d + k];
    }
  }
}

/// w P (dxi/dX)^T at one point: what does work on du/dxi there.
template <int dimension>
struct PointWork {
  Lanes at[dimension][dimension];
};
template <int dimension>
PointWork<dimension> work_at(const Tensor<Lanes>& P, Lanes w, const Lanes* inverse) {
  PointWork<dimension> work;
  for (int i = 0; i < dimension; ++i)
    for (int d = 0; d < dimension; ++d) work.at[i][d] = w * inner<dimension>(P.c + 3 * i, inverse + dimension * d);
  return work;
}

/// The forces at the nodes that do the work of all points, L being theirs: the transpose of slopes() and of what
/// displacement_gradient makes of them.
template <int dimension, int nodes, std::size_t count>
void set_forces(const PointWork<dimension> (&points)[count], const std::array<Barycentric<dimension>, count>& L,
                SimplexResult<dimension, nodes>& result) {
  auto& force = result.force;
  for (int i = 0; i < dimension; ++i) {
    if constexpr (nodes == dimension + 1) {
      Lanes sum{};
      for (int d = 0; d < dimension; ++d) {
        Lanes along = points[0].at[i][d];
        for (std::size_t q = 1; q < count; ++q) along += points[q].at[i][d];
        force[d + 1][i] = along;
        sum += along;
      }
      force[0][i] = -sum;
    } else {
      Lanes along[dimension + 1][dimension + 1];  // [c][j]: on the slope at corner c towards corner j
      for (std::size_t c = 0; c <= dimension; ++c) {
        Lanes back{};
        for (std::size_t d = 0; d < dimension; ++d) {
          Lanes sum = L[0][c] * points[0].at[i][d];
          for (std::size_t q = 1; q < count; ++q) sum += L[q][c] * points[q].at[i][d];
          along[c][d + 1] = sum;
          back -= sum;
        }
        along[c][0] = back;
      }
      for (std::size_t c = 0; c <= dimension; ++c) {
        Lanes own{};
        for (std::size_t j = 0; j <= dimension; ++j) {
          if (j == c) continue;
          own -= 3.0 * along[c][j] + along[j][c];
          if (j > c) force[mid_nodes<dimension, nodes>[c][j]][i] = 4.0 * (along[c][j] + along[j][c]);
        }
        force[c][i] = own;
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
