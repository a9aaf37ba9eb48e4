// SPDX-License-Identifier: GPL-3.0-or-later
// When Newton's method ends: residual, increment and energy, each beside a physical scale.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

/// A particle between two springs along x that are stretched from `rest` to 1, each of them.
struct Strung {
  double stiffness, rest;
  Vec3 force;
};

/// Strung particles far from each other, node k the k-th.
Model strung(const std::vector<Strung>& parts) {
  Model model;
  Mesh mesh;
  mesh.points = Points::Zero(static_cast<Eigen::Index>(parts.size()), 3);
  Step step{.name = "pull", .dt = 1, .count = 1, .gravity = Vec3::Zero()};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const int node = static_cast<int>(k);
    const Vec3 place(10.0 * node, 0, 0);
    mesh.points.row(node) = place.transpose();
    model.point_masses.push_back({node, 1});
    for (const double side : {-1.0, 1.0})
      step.springs.push_back({.name = "string",
                              .first = node,
                              .point = place + Vec3(side, 0, 0),
                              .stiffness = parts[k].stiffness,
                              .rest = parts[k].rest});
    step.forces.push_back({.name = "pull", .nodes = {node}, .values = {parts[k].force}});
  }
  model.mesh = std::make_shared<const Mesh>(mesh);
  model.steps = {step};
  model.settings.integrator = Integrator::static_;
  return model;
}

/// How far a force across the springs pulls the particle: 2 k (l - rest) w / l = f with l^2 = 1 + w^2, by bisection.
double pulled(const Strung& part) {
  const double f = part.force.norm();
  double low = 0, high = 1 + part.rest + f / part.stiffness;
  for (int k = 0; k < 200; ++k) {
    const double w = 0.5 * (low + high), l = std::hypot(1, w);
    (2 * part.stiffness * (l - part.rest) * w / l < f ? low : high) = w;
  }
  return low;
}

// Of forces of 1e10 the residual may leave 100: all that acts on the soft particle. After one step it is at 5 instead
// of 1.2.
TEST(Newton, LargeForcesElsewhereDoNotHideASoftPartsWay) {
  const Strung stiff{1e10, 0.5, {1e10, 0, 0}}, soft{1, 0.9, {0, 0, 1}};
  const Outcome outcome = solve(strung({stiff, soft}), {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  // Tolerance 1e-8 of the largest displacement, which is the soft one's.
  EXPECT_NEAR(outcome.state.displacement(1, 2), pulled(soft), 1e-7);
}

// The same over a history of loads: their growth from step to step is nothing beside the forces that stay.
TEST(Newton, LargeForcesElsewhereDoNotHideLoadsThatGrow) {
  const Strung stiff{1e10, 0.5, {1e10, 0, 0}}, soft{1, 0.5, {0, 0, 1}};
  Model model = strung({stiff, soft});
  model.settings.integrator = Integrator::quasi_static;
  model.steps[0].count = 10;
  model.steps[0].forces[1].factor = TimeFunction([](double t) { return t; });
  const Outcome outcome = solve(model, [&](const State& state) {
    if (state.increment > 0) {
      EXPECT_NEAR(state.displacement(1, 2), pulled({1, 0.5, {0, 0, state.time}}), 1e-7) << state.time;
    }
    return true;
  });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
}

TEST(ArcLength, LargeForcesElsewhereDoNotHideASoftPartsWay) {
  const Strung stiff{1e10, 0.5, {1e10, 0, 0}}, soft{1, 0.9, {0, 0, 1}};
  Model model = strung({stiff, soft});
  model.settings.arc_length = {.on = true, .steps = 20, .load = 1};
  model.settings.load_steps = 10;
  const Outcome outcome = solve(model, [&](const State& state) {
    EXPECT_NEAR(state.displacement(1, 2), pulled({1, 0.9, {0, 0, state.load_factor}}), 1e-7) << state.load_factor;
    return true;
  });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GT(outcome.state.load_factor, 0.9);
}

// Residual and increment are small beside what two other particles see; what is missing of the third's way, 1e-7 after
// two steps, shows in the energy alone.
TEST(Newton, TheEnergyShowsWhatForcesAndDisplacementsOfOtherPartsHide) {
  const Strung stiff{1e13, 1 - 1e-6, {1e8, 0, 0}}, far{1e-6, 0, {0, 2e-3, 0}}, middle{1e4, 0.9, {0, 0, 100}};
  const Outcome outcome = solve(strung({stiff, far, middle}), {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_NEAR(outcome.state.displacement(1, 1), 1e3, 1e-5);
  // Energies of 250 of the first and 100 of the third: K d^2 <= 1e-16 * 350 with K = 2000 leaves d = 4e-12.
  EXPECT_NEAR(outcome.state.displacement(2, 2), pulled(middle), 1e-11);
}

// A beam that would take more iterations, alone and beside a stiff string that is pulled by 1e10.
TEST(Newton, SaysWhichCriterionFailed) {
  for (const bool hidden : {true, false}) {
    Model model = beam_model(1, CellKind::tet10, 0.3, Strain::corotated);
    model.settings.newton_iterations = 2;
    model.settings.tolerance = 1e-12;
    Step& step = model.steps[0];
    step.gravity *= 100;
    if (hidden) {
      Mesh mesh = *model.mesh;
      const int node = mesh.point_count();
      mesh.points.conservativeResize(node + 1, 3);
      mesh.points.row(node).setZero();
      model.mesh = std::make_shared<const Mesh>(mesh);
      model.point_masses = {{node, 1}};
      step.springs = {{.name = "string", .first = node, .point = Vec3(1, 0, 0), .stiffness = 1e12}};
      step.forces = {{.name = "pull", .nodes = {node}, .values = {Vec3(1e10, 0, 0)}}};
    }
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::newton_limit);
    EXPECT_THAT(outcome.diagnosis,
                HasSubstr(hidden ? "within tolerance = 1e-12 for the residual, but not for increment ("
                                 : "the criterion of the residual is not met, tolerance = 1e-12"));
  }
}

// The second solution would tell nothing, also where the first left as much as it may: then its increment is above the
// tolerance.
TEST(Newton, EndsLinearProblemsAfterOneSolution) {
  for (const bool iterative : {false, true}) {
    Model model = beam_model(2, CellKind::tet10, 0.3, Strain::small);
    if (iterative) {
      model.settings.linear_solver = LinearSolver::cg;
      model.settings.preconditioner = Preconditioner::jacobi;
      model.settings.tolerance = model.settings.linear_tolerance = 1e-4;
    }
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged);
    EXPECT_EQ(outcome.newton_iterations, 1) << iterative;
    EXPECT_EQ(outcome.linear_solves, 1) << iterative;
  }
}

}  // namespace
}  // namespace msml::fe
