// SPDX-License-Identifier: GPL-3.0-or-later
// The cantilever under its own weight against other programs on the same mesh.
#include <gtest/gtest.h>

#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

double static_tip(int n, CellKind kind, double poisson_ratio) {
  const Model model = beam_model(n, kind, poisson_ratio, Strain::small);
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_LT(outcome.check.residual, 1e-9);
  EXPECT_LT(outcome.check.balance, 1e-9);
  return tip(model, outcome.state)[2];
}

// Six digits are published: half a unit of the last one is 5e-8.
TEST(Beam, SmallStrainAgreesWithOtherProgramsToSixDigits) {
  EXPECT_NEAR(static_tip(4, CellKind::tet10, 0.3), -0.0375280, 6e-8);  // CalculiX, DOLFINx
  EXPECT_NEAR(static_tip(4, CellKind::tet4, 0.3), -0.0298606, 6e-8);   // CalculiX, DOLFINx
  EXPECT_NEAR(static_tip(8, CellKind::tet4, 0.49), -0.0215850, 6e-8);  // CalculiX
}

TEST(Beam, CorotatedImplicitEulerAgreesWithOtherProgramsAfterThirteenSteps) {
  Model model = beam_model(6, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.integrator = Integrator::implicit_euler;
  model.settings.newton_iterations = 1;
  model.steps[0].dt = 1.0 / 30;
  model.steps[0].count = 13;
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const Vec3 u = tip(model, outcome.state);
  // SOFA and VegaFEM, seven decimals; their CG stops at 1e-6 of the residual, so the last digit may differ by one.
  EXPECT_NEAR(u[0], -0.0058808, 1.5e-7);
  EXPECT_NEAR(u[1], 0.0009183, 1.5e-7);
  EXPECT_NEAR(u[2], -0.0323083, 1.5e-7);
}

}  // namespace
}  // namespace msml::fe
