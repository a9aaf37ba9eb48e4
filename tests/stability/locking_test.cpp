// SPDX-License-Identifier: GPL-3.0-or-later
// Linear tetrahedra lock as Poisson's ratio nears one half; the other elements do not. The bending is known exactly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "tests/stability/bars.hpp"

namespace msml::fe {
namespace {

using namespace testing;

constexpr std::array<double, 6> ratios{0.3, 0.4, 0.45, 0.49, 0.499, 0.4999};

/// Deflection of the end of a bar bent by a moment, as a share of the exact one, kappa L^2/2.
double share(CellKind kind, Formulation formulation, int n, double poisson_ratio) {
  const double kappa = 1e-3;
  Model model = bent_bar(kind, n, poisson_ratio, kappa);
  model.formulation = formulation;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const int tip = nearest_point(*model.mesh, {bar_length, 0.5, 0.5});
  return outcome.state.displacement(tip, 2) / (kappa * bar_length * bar_length / 2);
}

TEST(Locking, LinearTetrahedraStiffenTowardsOneHalf) {
  double before = 1;
  std::array<double, 6> found;
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    found[k] = share(CellKind::tet4, Formulation::standard, 2, ratios[k]);
    std::printf("tet4, nu = %-6g: %.4f of the exact deflection\n", ratios[k], found[k]);
    EXPECT_LT(found[k], before) << ratios[k];
    before = found[k];
  }
  EXPECT_LT(found[5], 0.5 * found[0]);
}

/// Order at which the deflection's error falls from 10 x 4 x 4 cubes to 20 x 8 x 8; 2 in theory where nothing locks.
double order(Formulation formulation, double poisson_ratio) {
  const double coarse = 1 - share(CellKind::tet4, formulation, 2, poisson_ratio);
  const double fine = 1 - share(CellKind::tet4, formulation, 4, poisson_ratio);
  std::printf("tet4%s, nu = %g: error %.4f, half the size %.4f\n",
              formulation == Formulation::fbar ? " with averaged volumes" : "", poisson_ratio, coarse, fine);
  return std::log2(coarse / fine);
}

// On such coarse meshes the order of 2 is met from below, within 0.5; a locked mesh gains next to nothing.
TEST(Locking, RefinementHelpsWhereNothingLocks) {
  EXPECT_NEAR(order(Formulation::standard, 0.3), 2, 0.5);
  EXPECT_LT(order(Formulation::standard, 0.4999), 0.1);
  EXPECT_NEAR(order(Formulation::fbar, 0.4999), 2, 0.5);
}

TEST(Locking, QuadraticAndMixedTetrahedraBendExactly) {
  for (const double nu : ratios) {
    // The solution is quadratic in X: what is left is round-off, amplified by 1/(1 - 2 nu).
    EXPECT_NEAR(share(CellKind::tet10, Formulation::standard, 1, nu), 1, 1e-8 / (1 - 2 * nu)) << nu;
    EXPECT_NEAR(share(CellKind::tet10, Formulation::mixed, 1, nu), 1, 1e-8 / (1 - 2 * nu)) << nu;
  }
}

TEST(Locking, AveragedVolumesDoNotStiffenTowardsOneHalf) {
  double least = 1, most = 0;
  for (const double nu : ratios) {
    const double found = share(CellKind::tet4, Formulation::fbar, 2, nu);
    std::printf("tet4 with averaged volumes, nu = %-6g: %.4f\n", nu, found);
    least = std::min(least, found), most = std::max(most, found);
  }
  EXPECT_LT(most - least, 0.02);  // of the exact deflection; linear elements without it lose half of theirs
}

}  // namespace
}  // namespace msml::fe
