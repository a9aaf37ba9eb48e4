// SPDX-License-Identifier: GPL-3.0-or-later
// How far laws carry a compressed bar: St. Venant-Kirchhoff's turns back at 1/sqrt(3), that with ln J never does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

bool at_base(const Vec3& x) { return x[0] < 1e-9; }
bool at_end(const Vec3& x) { return x[0] > 2 - 1e-9; }

/// A bar [0,2] x [0,1] x [0,1] with E = 1 and nu = 0 that moves along x alone: its state is one stretch.
Model rod(const std::string& tag, std::vector<std::pair<std::string, Value>> attributes) {
  Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet4), {});
  attributes.insert(attributes.end(), {{"youngModulus", 1.0}, {"poissonRatio", 0.0}});
  model.regions[0].law = law_by_name(tag, attributes);
  const auto all = points_where(*model.mesh, [](const Vec3&) { return true; });
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_base)), fix(all, false, true, true)};
  return model;
}

/// The rod pressed by a dead force per reference area.
Model pressed(Model model, double pressure) {
  FaceLoad load{.name = "press", .tractions = {Vec3(-pressure, 0, 0)}};
  load.faces = faces_where(*model.mesh, at_end);
  model.steps[0].face_loads = {load};
  model.settings.load_steps = 20;
  return model;
}

double stretch(const Model& model, const Outcome& outcome) {
  return 1 + outcome.state.displacement(nearest_point(*model.mesh, {2, 0, 0}), 0) / 2;
}

// P = E/2 l (l^2 - 1) is least at l = 1/sqrt(3): -E/(3 sqrt(3)). Within 1 % of that force on either side.
TEST(StVenantKirchhoff, CarriesNoMoreThanTheForceAtOneOverRootThree) {
  const double limit = 1 / (3 * std::sqrt(3.0));
  const Model below = pressed(rod("stVenantKirchhoffMaterial", {}), 0.99 * limit);
  const Outcome holds = solve(below, {});
  ASSERT_EQ(holds.stop, Stop::converged) << holds.diagnosis;
  const double l = stretch(below, holds);
  EXPECT_NEAR(0.5 * l * (1 - l * l), 0.99 * limit, 1e-8);
  EXPECT_GT(l, 1 / std::sqrt(3.0));

  const Model above = pressed(rod("stVenantKirchhoffMaterial", {}), 1.01 * limit);
  int states = 0;
  const Outcome fails = solve(above, [&](const State&) { return ++states > 0; });
  EXPECT_NE(fails.stop, Stop::converged);
  EXPECT_THAT(fails.diagnosis, HasSubstr("stopped at"));
  EXPECT_TRUE(fails.state.displacement.allFinite());
  EXPECT_GT(stretch(above, fails), 1 / std::sqrt(3.0)) << "the last good state lies before the turn";
  EXPECT_GE(states, 19);
}

// Held at both ends the rod passes the turn, and its equilibrium is unstable from there on: the inner nodes are on a
// descending branch. The last good state lies within one load step (2.5 % of the length) of 1/sqrt(3).
TEST(StVenantKirchhoff, ARodShortenedBelowOneOverRootThreeIsSaidToBeUnstable) {
  Model model = rod("stVenantKirchhoffMaterial", {});
  Prescribed end{.name = "end", .nodes = points_where(*model.mesh, at_end), .values = {Vec3(-1, 0, 0)}};
  model.steps[0].prescribed.push_back(end);
  model.settings.load_steps = 20;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::indefinite_tangent) << outcome.diagnosis;
  EXPECT_THAT(outcome.diagnosis, HasSubstr("unstable"));
  EXPECT_NEAR(stretch(model, outcome), 1 / std::sqrt(3.0), 0.025);
  EXPECT_GT(stretch(model, outcome), 1 / std::sqrt(3.0));
}

// nu = 0: P = mu (l - 1/l), mu = E/2, so that l - 1/l = -2 p/E has a solution for every load.
TEST(NeoHookean, TheLogarithmCarriesEveryPressure) {
  for (const double pressure : {0.2, 2.0, 20.0}) {
    const Model model = pressed(rod("neoHookeanMaterial", {{"form", std::string("log")}}), pressure);
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const double exact = -pressure + std::sqrt(pressure * pressure + 1);
    EXPECT_NEAR(stretch(model, outcome), exact, 1e-7 * exact) << pressure;
  }
}

// Pushed through itself the rod has no state with J > 0: the line search stops at the barrier, and without it the run
// ends just as well, never with a number that is none.
TEST(NeoHookean, TheLogarithmStopsAnInversionWithOrWithoutALineSearch) {
  for (const bool line_search : {true, false}) {
    Model model = rod("neoHookeanMaterial", {{"form", std::string("log")}});
    Prescribed end{.name = "end", .nodes = points_where(*model.mesh, at_end), .values = {Vec3(-2.6, 0, 0)}};
    model.steps[0].prescribed.push_back(end);
    model.settings.load_steps = 10;
    model.settings.line_search = line_search;
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::inverted_element) << line_search << ": " << outcome.diagnosis;
    EXPECT_TRUE(outcome.state.displacement.allFinite());
    EXPECT_GT(outcome.check.smallest_J, 0);
    EXPECT_LT(stretch(model, outcome), 0.13) << "one load step before nothing is left";
  }
}

}  // namespace
}  // namespace msml::fe
