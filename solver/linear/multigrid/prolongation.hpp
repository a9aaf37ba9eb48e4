// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongations of low energy.
#pragma once
#include "solver/linear/multigrid/aggregates.hpp"

namespace msml::fe {

/// Lowers the energy tr(P^T A P) of the columns of P by `steps` of conjugate gradients, within the sparsity of P and
/// with P B_c unchanged, where B_c are the modes on the coarse grid: those that P reproduces it goes on to reproduce
/// (Mandel, Brezina and Vanek 1999, doi 10.1007/s006070050022; Olson, Schroder and Tuminaro 2011,
/// doi 10.1137/100803031). Nearly incompressible bodies want several steps: what changes the volume is stiff, and
/// averages leave too much of it. coarse_modes: C x 6 for each coarse node, column by column; inverse: the inverses of
/// A's diagonal blocks. Rows of P that are zero stay so, and columns.
template <int B, int C>
void lower_energy(const Blocks<float, B, B>& A, const std::vector<double>& inverse, const Modes& coarse_modes,
                  int steps, Blocks<float, B, C>& P);

}  // namespace msml::fe
