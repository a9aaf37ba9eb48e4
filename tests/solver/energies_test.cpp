// SPDX-License-Identifier: GPL-3.0-or-later
// Energies, work and momentum of the states that every integrator reports.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// What the balance elastic + kinetic + dissipated = work misses, relative to the largest work.
double imbalance(const Model& model) {
  double worst = 0, scale = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    const Energies& e = state.energies;
    scale = std::max({scale, std::abs(e.external_work), e.elastic, e.kinetic});
    worst = std::max(worst, std::abs(e.elastic + e.kinetic + e.dissipated - e.external_work));
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return worst / scale;
}

// Average acceleration keeps the balance of a linear body exactly, with damping too.
TEST(Energies, BalanceInNewmarkToRoundOff) {
  const Oscillator o = oscillator(false);
  for (const double alpha : {0.0, 1.0}) {
    Model model = oscillator_model(Integrator::newmark, false, o.period() / 15, 300);
    model.settings.damping_mass = alpha;
    model.settings.damping_stiffness = 0.002 * alpha;
    EXPECT_LT(imbalance(model), 1e-10);
  }
}

TEST(Energies, DriftOfNewmarkInFreeVibrationIsBelowOneInAMillionPerPeriod) {
  Model model = beam_model(2, CellKind::tet10, 0.3, Strain::small);
  model.settings.integrator = Integrator::newmark;
  model.steps[0].dt = 0.01;
  model.steps[0].count = 200;  // about ten periods
  EXPECT_LT(imbalance(model), 1e-6);
}

// Halving the time step divides the imbalance of a method of order p by 2^p.
TEST(Energies, ImbalanceOfTheOtherMethodsFallsWithTheirOrder) {
  const double T = oscillator(true).period();
  const auto order = [&](Integrator integrator, double damping) {
    double found[2];
    for (const int fine : {0, 1}) {
      Model model = oscillator_model(integrator, true, T / 200 / (1 + fine), 200 * (1 + fine));
      model.settings.damping_stiffness = damping;
      found[fine] = imbalance(model);
    }
    return std::log2(found[0] / found[1]);
  };
  EXPECT_NEAR(order(Integrator::implicit_euler, 0), 1, 0.15);
  EXPECT_NEAR(order(Integrator::symplectic_euler, 0), 1, 0.15);
  EXPECT_NEAR(order(Integrator::central_difference, 0), 2, 0.15);
  EXPECT_NEAR(order(Integrator::central_difference, 0.02), 2, 0.15);
  EXPECT_NEAR(order(Integrator::forward_euler, 0.05), 1, 0.15);
}

TEST(Energies, OfAStaticStateAreTheWorkOfTheLoads) {
  for (const Integrator integrator : {Integrator::static_, Integrator::quasi_static}) {
    Model model = beam_model(2, CellKind::tet4, 0.3, Strain::small);
    model.settings.integrator = integrator;
    const Outcome outcome = solve(model, {});
    const Energies& e = outcome.state.energies;
    EXPECT_GT(e.elastic, 0);
    EXPECT_EQ(e.kinetic, 0);
    // Loads that come at once, in one step of the trapezoidal rule, count half as well: they are ramped.
    EXPECT_NEAR(e.external_work, e.elastic, 1e-9 * e.elastic);
  }
}

TEST(Energies, MovedSupportsDoWork) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4),
                           {.youngs_modulus = 100, .poisson_ratio = 0, .strain = Strain::small});
  Prescribed top{.name = "top",
                 .nodes = points_where(*model.mesh, [](const Vec3& x) { return x[2] > 1 - 1e-9; }),
                 .values = {Vec3(0, 0, 0.1)}};
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; })), top};
  model.settings.load_steps = 2;
  const Outcome outcome = solve(model, {});
  EXPECT_NEAR(outcome.state.energies.elastic, 0.5 * 100 * 0.01, 1e-10);
  EXPECT_NEAR(outcome.state.energies.external_work, 0.5 * 100 * 0.01, 1e-10);
}

/// The oscillator whose three other nodes move up and down by a function of time, from rest.
Model shaken_model(Integrator integrator, double alpha, int count) {
  const double T = oscillator(true).period(), rate = 0.6 * 2 * M_PI / T;
  Model model = oscillator_model(integrator, true, 1.5 * T / count, count, 0);
  model.settings.damping_mass = alpha / T;
  model.steps[0].prescribed[0].function = [=](const Vec3&, double t) {
    return Vec3(0, 0, 0.01 * (1 - std::cos(rate * t)));
  };
  return model;
}

// Whatever time within a step the balance of the method belongs to, the reactions do work at its middle.
TEST(Energies, ImbalanceBesideSupportsThatMoveByFunctionsIsOfSecondOrder) {
  for (const Integrator integrator :
       {Integrator::newmark, Integrator::generalized_alpha, Integrator::central_difference})
    for (const double alpha : {0.0, 1.0}) {
      const double coarse = imbalance(shaken_model(integrator, alpha, 200)),
                   fine = imbalance(shaken_model(integrator, alpha, 400));
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15) << name(integrator) << " " << alpha;
    }
}

/// A free body of soft corotated tetrahedra that was given a spin by forces on two opposite corners.
Model spinning(Integrator integrator) {
  Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet4), {.youngs_modulus = 500}, 1);
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-12;
  model.steps[0].dt = 0.002;
  model.steps[0].count = 50;
  model.steps[0].forces = {{.name = "spin",
                            .nodes = {nearest_point(*model.mesh, {0, 0, 0}), nearest_point(*model.mesh, {2, 1, 1})},
                            .values = {Vec3(0, 20, 3), Vec3(0, -20, -3)}}};
  model.steps.push_back({.name = "free", .dt = 0.002, .count = 200, .gravity = Vec3::Zero()});
  return model;
}

TEST(Energies, MomentumOfAFreeBodyStaysToRoundOff) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark, Integrator::generalized_alpha,
                                      Integrator::symplectic_euler, Integrator::central_difference}) {
    const Model model = spinning(integrator);
    Vec3 spin = Vec3::Zero();
    double speed = 0, lost = 0;
    const Outcome outcome = solve(model, [&](const State& state) {
      speed = std::max(speed, std::sqrt(2 * 2 * state.energies.kinetic));  // mass 2: scale of momentum
      EXPECT_LT(state.energies.momentum.norm(), 1e-10 * std::max(speed, 1e-3)) << name(integrator);
      if (state.time > 0.1 + 1e-9 && spin.norm() == 0) spin = state.energies.angular_momentum;
      if (spin.norm() > 0) lost = std::max(lost, (state.energies.angular_momentum - spin).norm() / spin.norm());
      return true;
    });
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    // Symplectic methods keep the angular momentum: central differences to round-off, as positions and forces belong
    // to the same time; so does symplectic Euler up to a term that is periodic, of the size of dt.
    if (integrator == Integrator::central_difference) {
      EXPECT_LT(lost, 1e-10);
    } else if (integrator == Integrator::symplectic_euler) {
      EXPECT_LT(lost, 1e-10);
    }
    std::cout << name(integrator) << ": angular momentum changes by " << lost << " in free flight\n";
  }
}

}  // namespace
}  // namespace msml::fe
