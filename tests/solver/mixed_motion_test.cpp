// SPDX-License-Identifier: GPL-3.0-or-later
// Mixed elements that move: vibration, what a run begins with, and how they get to where a load bends them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/materials/linear_elastic.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

TEST(MixedElements, KeepTheEnergyOfAVibration) {
  Model model = beam_model(1, CellKind::tet10, 0.4999, Strain::small);
  model.formulation = Formulation::mixed;
  model.settings.integrator = Integrator::newmark;
  model.settings.tolerance = 1e-12;
  model.steps[0].dt = 0.005;
  model.steps[0].count = 40;
  double largest = 0, drift = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    const Energies& e = state.energies;
    largest = std::max(largest, e.kinetic);
    drift = std::max(drift, std::abs(e.kinetic + e.elastic - e.external_work));
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GT(largest, 0);
  EXPECT_LT(drift, 1e-8 * largest);  // the tolerance of 40 steps, amplified by the stiffness of the volume
}

constexpr double stretched = 0.1, sheared = 0.05, stretched_nu = 0.3;

/// A free cube of small strains that is let go at u = (stretched x + sheared y, 0, 0).
Model let_go(Formulation formulation, double dt, int count) {
  Model model = make_model(unit_mesh(2, CellKind::tet10),
                           {.youngs_modulus = 1000, .poisson_ratio = stretched_nu, .strain = Strain::small});
  model.formulation = formulation;
  model.settings.integrator = Integrator::newmark;
  model.settings.tolerance = 1e-12;
  model.steps[0].gravity = Vec3::Zero();
  model.steps[0].dt = dt;
  model.steps[0].count = count;
  model.initial_displacement = Points::Zero(model.mesh->point_count(), 3);
  model.initial_displacement.col(0) = stretched * model.mesh->points.col(0) + sheared * model.mesh->points.col(1);
  return model;
}

/// The state that a run begins with.
State first_state(const Model& model) {
  State first;
  solve(model, [&](const State& state) {
    first = state;
    return false;
  });
  return first;
}

// Under a uniform strain p = -lambda e and W = lambda e^2/2 + mu eps : eps, and the forces are those of plain elements.
TEST(MixedElements, BeginWithThePressureOfTheInitialDisplacement) {
  const State mixed = first_state(let_go(Formulation::mixed, 0.001, 1));
  const State plain = first_state(let_go(Formulation::standard, 0.001, 1));
  const double mu = 1000 / (2 * (1 + stretched_nu)), lambda = 2 * mu * stretched_nu / (1 - 2 * stretched_nu);
  EXPECT_THAT(mixed.pressure, ::testing::Each(::testing::DoubleNear(-lambda * stretched, 1e-10 * lambda * stretched)));
  const double squares = stretched * stretched + 0.5 * sheared * sheared;
  EXPECT_NEAR(mixed.energies.elastic, 0.5 * lambda * stretched * stretched + mu * squares, 1e-10);
  EXPECT_LT((mixed.acceleration - plain.acceleration).norm(), 1e-10 * plain.acceleration.norm());
}

TEST(MixedElements, KeepTheOrderOfNewmarkFromAnInitialDisplacement) {
  Points end[3];
  for (int fine = 0; fine < 3; ++fine)
    end[fine] = solve(let_go(Formulation::mixed, 0.0005 / (1 << fine), 10 << fine), {}).state.displacement;
  // Of differences; those of the next pair of steps lie as much nearer to 2 again.
  EXPECT_NEAR(std::log2((end[0] - end[1]).norm() / (end[1] - end[2]).norm()), 2, 0.1);
}

// Pressures have no inertia, so that what the method calls their acceleration means nothing and must not cut steps.
TEST(MixedElements, TakeNoMoreAdaptiveStepsThanPlainOnes) {
  int solves[2];
  for (const bool plain : {false, true}) {
    Model model = let_go(plain ? Formulation::standard : Formulation::mixed, 0.01, 2);
    model.settings.adaptive_step = true;
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    solves[plain] = outcome.linear_solves;
  }
  EXPECT_LT(solves[0], 1.2 * solves[1]);  // on a coarse mesh both move a little differently
}

// A slender body that bends far meets residuals of stretching on its way, which no merit of mixed elements ought to
// fear.
TEST(MixedElements, BendFarInHardlyMoreIterationsThanPlainOnes) {
  int plain = 0;
  for (const Formulation formulation : {Formulation::standard, Formulation::mixed}) {
    Model model = beam_model(2, CellKind::tet10, 0.49, Strain::corotated);
    model.regions[0].law = make_linear_elastic({.youngs_modulus = 1e4, .poisson_ratio = 0.49});
    model.formulation = formulation;
    const Outcome outcome = solve(model, [](const State&) { return true; });
    ASSERT_EQ(outcome.stop, Stop::converged) << static_cast<int>(formulation);
    EXPECT_LT(tip(model, outcome.state)[2], -0.05);
    if (formulation == Formulation::standard)
      plain = outcome.newton_iterations;
    else
      EXPECT_LE(outcome.newton_iterations, plain + 2);
  }
}

// The symmetric part of the tangent counts too many negative eigenvalues long before anything buckles, as in plain
// elements: the matrix as it is has the sign of its determinant.
TEST(MixedElements, BendUnderAPressureThatFollowsLikePlainOnes) {
  Vec3 end[2];
  for (const bool mixed : {false, true}) {
    Model model = make_model(box_mesh(8, 2, 2, {6, 1, 1}, CellKind::tet10), {});
    model.regions[0].law = law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
    model.formulation = mixed ? Formulation::mixed : Formulation::standard;
    model.settings.load_steps = 4;
    FaceLoad load{.name = "side", .pressures = {6}, .follower = true};
    load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[1] > 1 - 1e-9; });
    model.steps[0].face_loads = {load};
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    end[mixed] = outcome.state.displacement.row(nearest_point(*model.mesh, {6, 1, 1})).transpose();
  }
  EXPECT_LT(end[0][0], -6);                                   // bent to more than a right angle
  EXPECT_LT((end[1] - end[0]).norm(), 0.02 * end[0].norm());  // both are a coarse mesh's
}

// At the start the tangent is that of no stable equilibrium; the semidefinite one leads away from there.
TEST(MixedElements, ReturnToRestFromASqueezedStart) {
  for (const double nu : {0.3, 0.45, 0.49}) {
    Model model = make_model(unit_mesh(2, CellKind::tet10), {});
    model.regions[0].law = law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", nu}});
    model.formulation = Formulation::mixed;
    model.steps[0].gravity = Vec3::Zero();
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.initial_displacement = Points::Zero(model.mesh->point_count(), 3);
    model.initial_displacement.col(0) = -0.3 * model.mesh->points.col(0);
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << nu << ": " << outcome.diagnosis;
    EXPECT_LT(outcome.state.displacement.cwiseAbs().maxCoeff(), 1e-9) << nu;
  }
}

// No smaller step helps: with a quarter of it the same happens a little later.
TEST(MixedElements, SayThatNewmarkLetsThePressuresOfIncompressibleOnesSwing) {
  Model model = make_model(unit_mesh(2, CellKind::tet10), {}, 1);
  model.regions[0].law =
      law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"incompressible", true}, {"poissonRatio", Value{}}});
  model.formulation = Formulation::mixed;
  model.settings.integrator = Integrator::newmark;
  model.steps[0] = {.name = "let go", .dt = 0.002, .count = 100, .gravity = Vec3::Zero()};
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[1] < 1e-9; }))};
  model.initial_displacement = Points::Zero(model.mesh->point_count(), 3);
  model.initial_displacement.col(0) = 0.5 * model.mesh->points.col(1);
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::step_too_large);
  EXPECT_THAT(outcome.diagnosis, ::testing::HasSubstr("swing under Newmark's method"));
}

TEST(MixedElements, SayThatAnInitialDisplacementLeavesThePressureOfIncompressibleOnesOpenInStatics) {
  Model model = let_go(Formulation::mixed, 0.001, 1);
  model.settings.integrator = Integrator::quasi_static;
  model.regions[0].law =
      law_of("neoHookeanMaterial", {{"youngModulus", 3.0}, {"incompressible", true}, {"poissonRatio", Value{}}});
  model.initial_displacement.col(0) = sheared * model.mesh->points.col(1);
  const Outcome outcome = solve(model, {});
  EXPECT_THAT(outcome.notes, ::testing::Contains(::testing::HasSubstr("pressure in incompressible regions")));
}

}  // namespace
}  // namespace msml::fe
