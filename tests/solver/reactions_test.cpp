// SPDX-License-Identifier: GPL-3.0-or-later
// Reactions and accelerations of moving bodies against a forced oscillator.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;

struct Errors {
  double reaction, acceleration;  ///< largest of all states, beside the largest values
};

/// Of the oscillator from rest under f sin(w t), w = 0.6 omega: u = f/k / (1 - r^2) (sin w t - r sin omega t), r = 0.6.
/// The held nodes carry -k u, and with consistent masses the inertia 3 rho V / 20 u'' = 1.5 m u''.
Errors errors(Integrator integrator, bool lumped, int count, double radius) {
  const Oscillator o = oscillator(lumped);
  const double r = 0.6, w = r * o.omega(), f = 0.1, size = f / o.k / (1 - r * r);
  Model model = oscillator_model(integrator, lumped, 1.3 * o.period() / count, count, f);
  model.settings.spectral_radius = radius;
  model.steps[0].forces[0].factor = TimeFunction([w](double t) { return std::sin(w * t); });
  Errors worst{};
  const Outcome outcome = solve(model, [&](const State& state) {
    const double t = state.time, u = size * (std::sin(w * t) - r * std::sin(o.omega() * t)),
                 a = size * (r * o.omega() * o.omega() * std::sin(o.omega() * t) - w * w * std::sin(w * t));
    const double reaction = -o.k * u + (lumped ? 0 : 1.5 * o.m * a);
    worst.reaction = std::max(worst.reaction, std::abs(state.reaction.col(2).head(3).sum() - reaction) / f);
    worst.acceleration = std::max(worst.acceleration, std::abs(state.acceleration(3, 2) - a) * o.m / f);
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_LT(outcome.check.balance, 1e-10);
  return worst;
}

TEST(Reactions, AndAccelerationsBelongToTheTimeTheyAreWrittenAt) {
  for (const Integrator integrator : {Integrator::newmark, Integrator::generalized_alpha})
    for (const bool lumped : {false, true})
      for (const double radius : {0.0, 0.5, 0.8, 1.0}) {
        const Errors coarse = errors(integrator, lumped, 200, radius), fine = errors(integrator, lumped, 400, radius);
        EXPECT_NEAR(std::log2(coarse.reaction / fine.reaction), 2, 0.15) << name(integrator) << " " << radius;
        EXPECT_NEAR(std::log2(coarse.acceleration / fine.acceleration), 2, 0.15) << name(integrator) << " " << radius;
        EXPECT_LT(fine.reaction, 4e-3) << name(integrator) << " " << radius;
      }
}

/// The oscillator's other nodes move up and down by 0.01 (1 - cos w t), and it with them: seen from them it is forced
/// by the inertia of their motion. The sum of the forces on the body is the rate of its momentum.
TEST(Reactions, OfMovedSupportsGiveTheMomentum) {
  const double T = oscillator(true).period(), w = 0.6 * 2 * M_PI / T;
  double error[2];
  for (const int fine : {0, 1}) {
    const int count = 200 * (1 + fine);
    Model model = oscillator_model(Integrator::generalized_alpha, true, 1.5 * T / count, count, 0);
    model.steps[0].prescribed[0].function = [=](const Vec3&, double t) {
      return Vec3(0, 0, 0.01 * (1 - std::cos(w * t)));
    };
    double worst = 0;
    const double mass = density / 24, omega = 2 * M_PI / T, r = w / omega;  // of each node
    const Outcome outcome = solve(model, [&](const State& state) {
      // y'' + omega^2 y = -s'' with y from rest beside the supports, whose s'' = 0.01 w^2 cos w t.
      const double t = state.time, c = 0.01 * r * r / (1 - r * r);
      const double y = -c * (std::cos(w * t) - std::cos(omega * t));
      const double exact = 3 * mass * 0.01 * w * w * std::cos(w * t) - mass * omega * omega * y;
      worst = std::max(worst, std::abs(state.reaction.col(2).sum() - exact) / (mass * omega * omega * 0.01));
      return true;
    });
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    error[fine] = worst;
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.15);
  EXPECT_LT(error[1], 1e-3);
}

// One linear bar of mass m, whose left end starts with the acceleration s'' while nothing strains it. With the
// consistent mass m/6 (2 1; 1 2) the right end starts with -s''/2, and the support pushes with m s''/4; with half of m
// at each end, that is m s''/2 and the right end rests.
TEST(Reactions, OfTheFirstStateKnowTheInertiaOfMovedSupports) {
  constexpr double m = 0.6, rate = 9;
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark, Integrator::generalized_alpha,
                                      Integrator::symplectic_euler, Integrator::central_difference}) {
    Model model = make_model(segment_mesh(1, 1, CellKind::line2), {.youngs_modulus = 1, .poisson_ratio = 0}, m);
    model.settings.integrator = integrator;
    model.steps[0].dt = 0.01;
    Prescribed moved = fix({0});
    moved.function = [=](const Vec3&, double t) { return Vec3(t > 0 ? t + rate / 2 * t * t : 0, 0, 0); };
    model.steps[0].prescribed = {moved};
    const State first = solve(model, [](const State&) { return false; }).state;
    const double share = is_explicit(integrator) ? 0.5 : 0.25;
    // Round-off in displacements of 1e-3 beside the square of a tenth of dt.
    EXPECT_NEAR(first.reaction(0, 0), share * m * rate, 1e-9) << name(integrator);
    EXPECT_NEAR(first.acceleration(0, 0), rate, 1e-9) << name(integrator);
    EXPECT_NEAR(first.acceleration(1, 0), is_explicit(integrator) ? 0 : -rate / 2, 1e-9) << name(integrator);
    EXPECT_NEAR(first.velocity(0, 0), 1, 1e-12) << name(integrator);
  }
}

}  // namespace
}  // namespace msml::fe
