// SPDX-License-Identifier: GPL-3.0-or-later
// Past limit points of the load.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "msml/core/error.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

/// Pressure in an incompressible neo-Hookean sphere of radii 1 and 1.5, mu = 1: p = f(lb) - f(la), f(l) = 2/l +
/// 1/(2 l^4), lb^3 = 1 + (la^3 - 1)/1.5^3.
double pressure(double la) {
  const auto f = [](double l) { return 2 / l + 0.5 / (l * l * l * l); };
  return f(std::cbrt(1 + (la * la * la - 1) / (1.5 * 1.5 * 1.5))) - f(la);
}

Model sphere(int n, double poisson) {
  Model model = make_model(sphere_octant(n, 1, 1.5, CellKind::tet10), {});
  model.regions[0].law = neo_hookean("log", 2 * (1 + poisson), poisson);
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  const Mesh& mesh = *model.mesh;
  for (int c = 0; c < 3; ++c)
    model.steps[0].prescribed.push_back(
        fix(points_where(mesh, [&](const Vec3& x) { return near(x[c], 0); }), c == 0, c == 1, c == 2));
  FaceLoad inside{.name = "inside", .pressures = {0.4}, .follower = true};
  inside.faces = faces_where(mesh, [&](const Vec3& x) { return near(x.norm(), 1); });
  model.steps[0].face_loads = {inside};
  return model;
}

TEST(ArcLength, InflatesASpherePastItsLimitPoint) {
  EXPECT_NEAR(pressure(1.5), 0.4881755, 1e-6);
  EXPECT_NEAR(pressure(2), 0.4561059, 1e-6);
  Model model = sphere(2, 0.499);
  model.settings.load_steps = 4;
  model.settings.arc_length = {.on = true, .steps = 40, .displacement = 1};
  const int inner = nearest_point(*model.mesh, {1, 0, 0});
  double largest = 0, worst = 0, last = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    const double la = 1 + state.displacement(inner, 0), p = 0.4 * state.load_factor;
    largest = std::max(largest, p);
    if (la > 1.02) worst = std::max(worst, std::abs(p / pressure(la) - 1));
    last = la;
    return true;
  });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  std::cout << "inflated sphere, tet10 n = 2, nu = .499: largest error of p " << worst << ", to stretch " << last
            << " in " << outcome.state.increment << " steps, " << outcome.newton_iterations << " iterations\n";
  EXPECT_GE(last, 2);
  EXPECT_LT(0.4 * outcome.state.load_factor, 0.99 * largest);  // the load has come down again
  // Two curved elements through the wall, nu = .499 instead of 1/2.
  EXPECT_LT(worst, 0.03);
  ASSERT_FALSE(outcome.notes.empty());
  EXPECT_THAT(outcome.notes.front(), HasSubstr("limit point"));
}

TEST(ArcLength, FindsTheStateOfLoadControlBeforeTheLimitPoint) {
  Model model = beam_model(1, CellKind::tet10, 0.3, Strain::corotated);
  const Outcome direct = solve(model, {});
  model.settings.arc_length = {.on = true, .steps = 60, .load = 1};
  model.settings.load_steps = 3;
  std::vector<State> states;
  const Outcome outcome = solve(model, [&](const State& state) { return states.push_back(state), true; });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GE(outcome.state.load_factor, 1);
  // The same load by load control gives the same state.
  model.settings.arc_length.on = false;
  model.steps[0].gravity *= outcome.state.load_factor;
  const Outcome same = solve(model, {});
  EXPECT_LT((same.state.displacement - outcome.state.displacement).norm(), 1e-5 * same.state.displacement.norm());
}

// Where the path turns, a step in the direction of the tangent would pass the bound by far.
TEST(ArcLength, StopsAtALoadBoundNearTheTurn) {
  Model model = sphere(1, 0.499);
  model.settings.load_steps = 1;
  model.settings.arc_length = {.on = true, .steps = 40, .load = 1.2};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GE(outcome.state.load_factor, 1.2);
  EXPECT_LT(outcome.state.load_factor, 1.2 * 1.0015);
}

TEST(ArcLength, RefusesAStepWithoutLoads) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.arc_length.on = true;
  model.steps[0].gravity.setZero();
  try {
    solve(model, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.str(), HasSubstr("has no load when it starts, at t = 0"));
  }
}

TEST(ArcLength, RefusesMovedSupportsAndOtherIntegrators) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.arc_length.on = true;
  model.steps[0].prescribed[0].values = {Vec3(0.01, 0, 0)};
  EXPECT_THROW(solve(model, {}), Error);
  model.settings.integrator = Integrator::newmark;
  EXPECT_THROW(solve(model, {}), Error);
}

// A stiffening cube under traction: no limit point, so that only the bounds end it.
TEST(ArcLength, EndsAtItsBounds) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {});
  model.regions[0].law = neo_hookean("log", 1000, 0.3);
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  FaceLoad pull{.name = "pull", .tractions = {Vec3(100, 0, 0)}};
  pull.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
  model.steps[0].face_loads = {pull};
  model.settings.arc_length = {.on = true, .steps = 50, .load = 3};
  model.settings.load_steps = 2;
  const Outcome loaded = solve(model, {});
  ASSERT_EQ(loaded.stop, Stop::converged) << loaded.diagnosis;
  EXPECT_GE(loaded.state.load_factor, 3);
  EXPECT_LT(loaded.state.load_factor, 3.01);
  model.settings.arc_length = {.on = true, .steps = 50, .displacement = 0.25};
  const Outcome moved = solve(model, {});
  const double largest = moved.state.displacement.rowwise().norm().maxCoeff();
  EXPECT_GE(largest, 0.25);
  EXPECT_LT(largest, 0.2525);
}

}  // namespace
}  // namespace msml::fe
