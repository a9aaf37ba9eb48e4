// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium at each time of a load history.
#include <gtest/gtest.h>

#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

TEST(QuasiStatic, IsInEquilibriumWithTheFullLoadAtEveryTimeStep) {
  Model model = beam_model(1, CellKind::tet10, 0.3, Strain::corotated);
  const Outcome rest = solve(model, {});
  model.settings.integrator = Integrator::quasi_static;
  model.steps[0].dt = 0.5;
  model.steps[0].count = 3;
  std::vector<State> states;
  const Outcome outcome = solve(model, [&](const State& state) { return states.push_back(state), true; });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  ASSERT_EQ(states.size(), 4u);
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_DOUBLE_EQ(states[k].time, 0.5 * static_cast<double>(k));
    EXPECT_EQ(states[k].increment, static_cast<int>(k));
    EXPECT_EQ(states[k].velocity.norm(), 0);
    // Newton's tolerance: 1e-8 of the loads, times the slenderness of the beam.
    EXPECT_LT((states[k].displacement - rest.state.displacement).norm(), 1e-6 * rest.state.displacement.norm());
  }
}

TEST(QuasiStatic, RampsDisplacementsByTime) {
  Model model = make_model(box_mesh(1, 1, 2, {1, 1, 2}, CellKind::tet4),
                           {.youngs_modulus = 10, .poisson_ratio = 0, .strain = Strain::small});
  Prescribed top{.name = "top",
                 .nodes = points_where(*model.mesh, [](const Vec3& x) { return x[2] > 2 - 1e-9; }),
                 .values = {Vec3(0, 0, 0.4)}};
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; })), top};
  model.settings.integrator = Integrator::quasi_static;
  model.steps[0].count = 4;
  const int middle = nearest_point(*model.mesh, {0, 0, 1});
  solve(model, [&](const State& state) {
    EXPECT_NEAR(state.displacement(middle, 2), 0.05 * state.time, 1e-12);
    return true;
  });
}

}  // namespace
}  // namespace msml::fe
