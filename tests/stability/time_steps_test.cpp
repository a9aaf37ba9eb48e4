// SPDX-License-Identifier: GPL-3.0-or-later
// Time steps that are too large: explicit limits of a whole body, damping of implicit Euler, and Newmark's method where
// the problem is stiff and not linear. The limits of a single oscillator are those of tests/solver/explicit_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A linear cantilever under gravity, explicit, for `count` steps of dt.
Outcome swinging(Integrator method, double dt, int count, bool allow, double& largest) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::small);
  model.settings.integrator = method;
  model.settings.lumped_mass = true;
  model.settings.allow_unstable = allow;
  model.steps[0].dt = dt;
  model.steps[0].count = count;
  largest = 0;
  return solve(model, [&](const State& state) {
    largest = std::max(largest, state.displacement.rowwise().norm().maxCoeff());
    return true;
  });
}

// dt = 2/omega_max, omega_max from the largest eigenvalue (explicit_test holds it against a dense solver). Gravity
// swings the beam by twice its static deflection at most.
TEST(ExplicitBody, HoldsJustBelowTheLimitAndGrowsJustAboveIt) {
  Model still = beam_model(1, CellKind::tet4, 0.3, Strain::small);
  const double deflection = solve(still, {}).state.displacement.rowwise().norm().maxCoeff();
  for (const Integrator method : {Integrator::symplectic_euler, Integrator::central_difference}) {
    double largest;
    const double limit = swinging(method, 1, 1, false, largest).stable_step;
    const Outcome holds = swinging(method, 0.98 * limit, 3000, false, largest);
    EXPECT_EQ(holds.stop, Stop::converged) << holds.diagnosis;
    EXPECT_LT(largest, 3 * deflection);  // twice, and the higher modes
    swinging(method, 1.02 * limit, 3000, true, largest);
    EXPECT_GT(largest, 1e3 * deflection);
    const Outcome refused = swinging(method, 1.02 * limit, 3000, false, largest);
    EXPECT_EQ(refused.stop, Stop::unstable_step);
    EXPECT_THAT(refused.diagnosis, HasSubstr("is unstable above"));
    EXPECT_TRUE(refused.state.displacement.allFinite());
  }
}

// Each step divides the energy by 1 + w^2 dt^2, however large it is: it never grows, and the loss per period is known.
TEST(ImplicitEuler, DampsAtItsKnownRateAtEveryStep) {
  const Oscillator o = oscillator(false);
  for (const double wdt : {0.01, 0.1, 1.0, 10.0}) {
    const int count = wdt > 1 ? 5 : 40;
    const Model model = oscillator_model(Integrator::implicit_euler, false, wdt / o.omega(), count);
    std::vector<double> energy;
    solve(model, [&](const State& state) {
      const double x = state.displacement(3, 2) - 0.1 / o.k, v = state.velocity(3, 2);
      energy.push_back(0.5 * o.m * v * v + 0.5 * o.k * x * x);
      return true;
    });
    ASSERT_EQ(energy.size(), static_cast<std::size_t>(count + 1));
    // Newton's tolerance of 1e-12 per step, summed; the energy falls to 1e-10 of its start at most.
    EXPECT_NEAR(std::log(energy.back() / energy.front()) / count, -std::log1p(wdt * wdt), 1e-5) << wdt;
  }
}

/// A mass of 1 on an undamped spring of length 1, without gravity, thrown across it at speed 1: it circles about the
/// other end with omega = 1, while the spring swings at sqrt(k).
Model circling(double stiffness, double dt, int count) {
  Model model;
  Mesh mesh;
  mesh.points.resize(1, 3);
  mesh.points << 1, 0, 0;
  model.mesh = std::make_shared<const Mesh>(mesh);
  model.point_masses = {{0, 1}};
  model.initial_velocity = Points::Zero(1, 3);
  model.initial_velocity(0, 1) = 1;
  model.steps = {{.name = "circle", .dt = dt, .count = count, .gravity = Vec3::Zero()}};
  model.steps[0].springs = {{.name = "spring", .first = 0, .point = Vec3::Zero(), .stiffness = stiffness, .rest = 1}};
  model.settings.integrator = Integrator::newmark;
  return model;
}

struct Drift {
  double energy = 0;  ///< largest total energy beside that at the start, 1/2
  std::vector<std::string> warnings;
};
Drift drift(double stiffness, double dt, int newton_iterations) {
  Model model = circling(stiffness, dt, static_cast<int>(40 / dt));
  model.settings.newton_iterations = newton_iterations;
  Drift found{};
  found.warnings = solve(model, [&](const State& state) {
                     const double v = state.velocity.row(0).norm();
                     const double l = (model.mesh->points.row(0) + state.displacement.row(0)).norm();
                     found.energy = std::max(found.energy, (0.5 * v * v + 0.5 * stiffness * (l - 1) * (l - 1)) / 0.5);
                     return true;
                   }).warnings;
  return found;
}

// Average acceleration keeps the energy of linear bodies (dynamics_test) at every step, but not where a stiff spring
// turns: Simo and Tarnow, 1992, doi 10.1007/BF00913408. Here the spring swings 16 times in a step of 1.
TEST(Newmark, GainsEnergyWhereAStiffBodyTurnsInLargeSteps) {
  const Drift fine = drift(1e4, 0.01, 25), coarse = drift(1e4, 0.5, 25);
  std::cout << "Newmark: largest energy beside that at the start, dt = 0.01: " << fine.energy
            << ", dt = 0.5: " << coarse.energy << "\n";
  EXPECT_NEAR(fine.energy, 1, 1e-3);
  EXPECT_THAT(fine.warnings, IsEmpty());
  EXPECT_GT(coarse.energy, 100);
  EXPECT_THAT(coarse.warnings, ElementsAre(HasSubstr("makes energy")));
}

// The linear equation of one solve takes the spring's force off its line: an error that Newton's method would remove.
TEST(Newmark, OneSolvePerStepDriftsWhereNewtonsMethodDoesNot) {
  const Drift full = drift(1e4, 0.2, 25), one = drift(1e4, 0.2, 1), fine = drift(1e4, 0.01, 1);
  std::cout << "dt = 0.2: Newton's method " << full.energy << ", one solve " << one.energy
            << "; one solve, dt = 0.01: " << fine.energy << "\n";
  EXPECT_NEAR(full.energy, 1, 1e-2);
  EXPECT_GT(one.energy, 2);
  EXPECT_THAT(one.warnings, ElementsAre(HasSubstr("makes energy")));
  EXPECT_NEAR(fine.energy, 1, 1e-2);
  EXPECT_THAT(fine.warnings, IsEmpty());
}

}  // namespace
}  // namespace msml::fe
