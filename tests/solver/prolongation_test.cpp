// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongations of low energy.
#include "solver/linear/multigrid/prolongation.hpp"

#include <gtest/gtest.h>

#include "solver/equations.hpp"
#include "solver/linear/multigrid/corners.hpp"
#include "solver/linear/multigrid/level.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using Thin = Blocks<float, 3, 3>;

/// The free stiffness of a beam of tet10 near incompressibility, and means of corners at mid nodes.
struct Beam {
  Beam()
      : model(beam_model(2, CellKind::tet10, 0.49, Strain::small)),
        equations(model),
        A(equations.elements().pattern()),
        none(static_cast<std::size_t>(equations.size()), 0),
        corners(equations.geometry(), none) {
    Forces forces;
    equations.evaluate(Vector::Zero(equations.size()), {}, Want::tangent, forces, &A);
    EXPECT_TRUE(level.set(FreeBlocks(A, none)));
    P = corners.wide(FreeBlocks(A, none).view());
    const Vector& X = equations.positions();
    for (const int n : corners.node_of()) {
      Eigen::Matrix<double, 3, 6> mode;  // far from the origin modes are hard to tell apart
      const Vec3 x = (X.segment<3>(3 * n) / 0.1 + Vec3(1, 1, 1)).eval();
      mode << Mat3::Identity(), (Mat3() << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0).finished();
      modes.insert(modes.end(), mode.data(), mode.data() + 18);
    }
  }
  Model model;
  Equations equations;
  BlockMatrix A;
  Mask none;
  Corners corners;
  Level<3> level;
  Thin P;
  Modes modes;  ///< on corners
};

double block_entry(const Thin& P, int p, int i, int j) { return static_cast<double>(P.block(p)[3 * j + i]); }

/// tr(P^T A P), term by term.
double energy(const Beam& beam, const Thin& P) {
  Blocks<double, 3, 3> coarse;
  galerkin<3>(FreeBlocks(beam.A, beam.none), P, transposed(P), coarse);
  double sum = 0;
  for (int r = 0; r < coarse.sparsity.rows(); ++r)
    for (int p = coarse.sparsity.offsets[static_cast<std::size_t>(r)];
         p < coarse.sparsity.offsets[static_cast<std::size_t>(r) + 1]; ++p)
      for (int i = 0; i < 3 && coarse.sparsity.columns[static_cast<std::size_t>(p)] == r; ++i)
        sum += coarse.block(p)[4 * i];
  return sum;
}

/// The rigid motions that P makes of those of the corners: 18 for each node.
std::vector<double> motions(const Beam& beam, const Thin& P) {
  std::vector<double> made(18 * static_cast<std::size_t>(P.sparsity.rows()), 0.0);
  for (int n = 0; n < P.sparsity.rows(); ++n)
    for (int p = P.sparsity.offsets[static_cast<std::size_t>(n)];
         p < P.sparsity.offsets[static_cast<std::size_t>(n) + 1]; ++p)
      for (int m = 0; m < 6; ++m)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            made[static_cast<std::size_t>(18 * n + 3 * m + i)] +=
                block_entry(P, p, i, j) *
                beam.modes[static_cast<std::size_t>(18 * P.sparsity.columns[static_cast<std::size_t>(p)] + 3 * m + j)];
  return made;
}

TEST(Prolongation, EnergyFallsWithEachStep) {
  const Beam beam;
  double before = energy(beam, beam.P);
  for (int steps = 1; steps < 5; ++steps) {
    Thin P = beam.P;
    lower_energy(beam.level.matrix(), beam.level.inverse(), beam.modes, steps, P);
    const double now = energy(beam, P);
    EXPECT_LT(now, before) << steps;
    before = now;
  }
  EXPECT_LT(before, 0.5 * energy(beam, beam.P));  // averages change the volume
}

// A corner carries itself and must not change; the sums at mid nodes are of single precision.
TEST(Prolongation, MeetsRigidMotionsAsBefore) {
  const Beam beam;
  Thin P = beam.P;
  lower_energy(beam.level.matrix(), beam.level.inverse(), beam.modes, 4, P);
  const std::vector<double> before = motions(beam, beam.P), after = motions(beam, P);
  double off = 0;
  for (std::size_t k = 0; k < before.size(); ++k) off = std::max(off, std::abs(before[k] - after[k]));
  EXPECT_LT(off, 1e-5);
  for (const int n : beam.corners.node_of()) {
    const int p = P.sparsity.offsets[static_cast<std::size_t>(n)];
    for (int i = 0; i < 9; ++i) EXPECT_EQ(P.block(p)[i], i % 4 == 0 ? 1.0f : 0.0f);
  }
}

}  // namespace
}  // namespace msml::fe
