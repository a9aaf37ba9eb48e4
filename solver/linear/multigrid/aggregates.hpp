// SPDX-License-Identifier: GPL-3.0-or-later
// Coarser problems from groups of nodes: smoothed aggregation.
#pragma once
#include <Eigen/Core>

#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

/// The group of each node, -1 for nodes without one.
struct Aggregates {
  std::vector<int> of;
  int count = 0;
};

/// Groups of strongly coupled neighbours, greedily: first whole free neighbourhoods, then what is left joins the group
/// it is coupled to most (Vanek, Mandel and Brezina 1996, doi 10.1007/BF02238511). Nodes with skip[n] != 0 get none.
/// Matrix: Blocks<double, B, B> or, with B = 3, FreeBlocks.
template <int B, class Matrix>
Aggregates aggregate(const Matrix& A, const std::vector<char>& skip);

/// Motions that cost no energy, B numbers for each of six at every node: modes[6 B n + B m + i].
using Modes = std::vector<double>;

/// The prolongation from groups to nodes that reproduces the modes, smoothed once by damped block-Jacobi, in single
/// precision; `coarse` receives the modes on the groups. inverse: the inverses of A's diagonal blocks; radius: largest
/// eigenvalue of inverse A.
template <int B, class Matrix>
Blocks<float, B, 6> prolongation(const Matrix& A, const std::vector<double>& inverse, double radius,
                                 const Aggregates& groups, const Modes& modes, Modes& coarse);

/// P^T A P, with a unit diagonal where P leaves a coarse unknown without a share. `P_transposed` is P^T.
template <int B, class Matrix, int C>
void galerkin(const Matrix& A, const Blocks<float, B, C>& P, const Blocks<float, C, B>& P_transposed,
              Blocks<double, C, C>& coarse);

}  // namespace msml::fe
