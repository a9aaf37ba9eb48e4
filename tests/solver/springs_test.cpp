// SPDX-License-Identifier: GPL-3.0-or-later
// Springs: forces, tangents, and the pendulum against the exact oscillator.
#include <gtest/gtest.h>

#include "msml/core/error.hpp"
#include "solver/equations.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// Particles of these masses at the rows of `points`, one step without loads.
Model particles(const Points& points, const std::vector<double>& masses) {
  Model model;
  Mesh mesh;
  mesh.points = points;
  model.mesh = std::make_shared<const Mesh>(mesh);
  for (std::size_t n = 0; n < masses.size(); ++n) model.point_masses.push_back({static_cast<int>(n), masses[n]});
  model.steps = {{.name = "s", .dt = 1, .count = 1, .gravity = Vec3::Zero()}};
  return model;
}

Points row(double x, double y, double z) { return Vec3(x, y, z).transpose(); }

/// Two particles at the origin and at (3 4 0), without steps' loads.
Model pair(double rest, bool to_point) {
  Points points(2, 3);
  points << 0, 0, 0, 3, 4, 0;
  Model model = particles(points, {2, 3});
  Spring spring{.name = "spring", .first = 0, .second = 1, .stiffness = 10, .damping = 7, .rest = rest};
  if (to_point) spring.second = -1, spring.point = Vec3(3, 4, 0);
  model.steps[0].springs = {spring};
  return model;
}

struct Evaluated {
  double energy;
  Vector internal;
  BlockMatrix tangent;
};

Evaluated evaluate(const Equations& equations, const Vector& u, Want want = Want::tangent) {
  Forces forces;
  BlockMatrix K(equations.elements().pattern());
  equations.evaluate(u, {{&equations.loads(0), 1, 0}}, want, forces, &K);
  return {forces.found.energy, forces.internal, K};
}

TEST(Springs, PullWithTheirStretch) {
  const Model model = pair(2, false);
  const Equations equations(model);
  const Evaluated now = evaluate(equations, Vector::Zero(6));
  const auto at = [&](int point) -> Vec3 {
    return now.internal.segment<3>(3 * equations.numbering().number_of[static_cast<std::size_t>(point)]);
  };
  // Length 5, stretch 3, tension 30 along (0.6 0.8 0): the first node is pulled to the second.
  EXPECT_LT((at(0) + 30 * Vec3(0.6, 0.8, 0)).norm(), 1e-13);
  EXPECT_LT((at(1) - 30 * Vec3(0.6, 0.8, 0)).norm(), 1e-13);
  EXPECT_DOUBLE_EQ(now.energy, 45);
}

// Central differences of step 1e-5: their error is of order 1e-10 of the tangent, their round-off of order 1e-11.
TEST(Springs, ForceIsDerivativeOfEnergyAndTangentOfForce) {
  for (const bool to_point : {false, true})
    for (const double rest : {0.0, 2.0, 9.0}) {
      const Model model = pair(rest, to_point);
      const Equations equations(model);
      Vector u(6);
      u << 0.1, -0.2, 0.3, 0.4, 0.1, -0.5;
      const Evaluated now = evaluate(equations, u);
      for (Eigen::Index k = 0; k < 6; ++k) {
        Vector up = u, down = u, e = Vector::Zero(6), column;
        up[k] += 1e-5, down[k] -= 1e-5, e[k] = 1;
        const Evaluated high = evaluate(equations, up), low = evaluate(equations, down);
        EXPECT_NEAR((high.energy - low.energy) / 2e-5, now.internal[k], 1e-8);
        multiply(now.tangent, e, column);
        EXPECT_LT(((high.internal - low.internal) / 2e-5 - column).norm(), 1e-8);
      }
    }
}

TEST(Springs, SemidefiniteTangentOfACompressedSpringLeavesOutItsSide) {
  const Model model = pair(9, true);
  const Equations equations(model);
  const BlockMatrix K = evaluate(equations, Vector::Zero(6), Want::definite_tangent).tangent;
  Vector across(6), along(6), y;
  across << 0.8, -0.6, 0, 0, 0, 0;
  along << 0.6, 0.8, 0, 0, 0, 0;
  multiply(K, across, y);
  EXPECT_LT(y.norm(), 1e-13);
  multiply(K, along, y);
  EXPECT_NEAR(dot(along, y), 10, 1e-13);
}

TEST(Springs, AtANodeWithoutMassOrElementAreRefused) {
  Model model = pair(2, false);
  model.point_masses.pop_back();
  try {
    const Equations equations(model);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "spring 'spring' pulls at node 1, which belongs to no element and has no mass");
  }
}

constexpr double mass = 2, stiffness = 50, weight = 9.81;

/// A mass below a fixed point, at the rest length of its spring, under gravity, for `count` steps of dt.
Model pendulum(Integrator integrator, double dt, int count, double damping = 0) {
  Model model = particles(row(0, 0, -1), {mass});
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-12;
  model.settings.allow_unstable = true;
  Step step{.name = "s", .dt = dt, .count = count, .gravity = Vec3(0, 0, -weight)};
  step.springs = {
      {.name = "s", .first = 0, .point = Vec3::Zero(), .stiffness = stiffness, .damping = damping, .rest = 1}};
  model.steps = {step};
  return model;
}

const double omega = std::sqrt(stiffness / mass);

/// w (z - z_rest) and v of the last state: a point that goes round a circle in the exact motion without damping.
std::array<double, 2> phase(const Outcome& outcome) {
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const State& state = outcome.state;
  return {omega * (state.displacement(0, 2) + mass * weight / stiffness), state.velocity(0, 2)};
}

double radius(const std::array<double, 2>& z) { return std::hypot(z[0], z[1]); }

const double start = omega * mass * weight / stiffness;  // radius of the circle

// Newmark's period error is (w dt)^2/12 of the phase: 2 pi (0.0314)^2/12 = 5.2e-4 after one period of 200 steps.
TEST(Pendulum, FollowsTheDampedOscillator) {
  const double period = 2 * M_PI / omega;
  for (const double zeta : {0.0, 0.05, 0.3}) {
    const double c = 2 * zeta * std::sqrt(stiffness * mass), wd = omega * std::sqrt(1 - zeta * zeta);
    const Outcome outcome = solve(pendulum(Integrator::newmark, period / 200, 150, c), {});
    const double t = 0.75 * period, sag = mass * weight / stiffness;
    const double exact =
        -sag * (1 - std::exp(-zeta * omega * t) * (std::cos(wd * t) + zeta * omega / wd * std::sin(wd * t)));
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_NEAR(outcome.state.displacement(0, 2), exact, 6e-4 * sag) << zeta;
  }
}

TEST(Pendulum, ImplicitEulerDampsByItsKnownRate) {
  for (const double dt : {0.01, 0.1, 1.0}) {
    const double expected = start * std::pow(1 + omega * omega * dt * dt, -5);  // 10 steps
    EXPECT_NEAR(radius(phase(solve(pendulum(Integrator::implicit_euler, dt, 10), {}))), expected, 1e-8 * start) << dt;
  }
}

TEST(Pendulum, ForwardEulerGrowsByItsKnownRate) {
  const double dt = 0.01, expected = start * std::pow(1 + omega * omega * dt * dt, 50);  // 100 steps
  EXPECT_NEAR(radius(phase(solve(pendulum(Integrator::forward_euler, dt, 100), {}))), expected, 1e-10 * expected);
}

// Its limit c/k is that of one direction, the others being held.
TEST(Pendulum, ForwardEulerKnowsTheLimitThatADamperGivesIt) {
  const double c = 0.3;
  Model model = pendulum(Integrator::forward_euler, 1, 1, c);
  model.settings.allow_unstable = false;
  model.steps[0].prescribed = {
      {.name = "line", .nodes = {0}, .values = {Vec3::Zero()}, .components = {true, true, false}}};
  const double limit = c / model.steps[0].springs[0].stiffness;
  for (const double share : {0.98, 1.02}) {
    model.steps[0].dt = share * limit;
    EXPECT_EQ(solve(model, {}).stop, share < 1 ? Stop::converged : Stop::unstable_step) << share;
  }
}

// With damping forward Euler is stable below 2 zeta/omega, and grows above.
TEST(Pendulum, ForwardEulerIsStableBelowItsLimit) {
  const double zeta = 0.1, c = 2 * zeta * std::sqrt(stiffness * mass), limit = 2 * zeta / omega;
  const auto end = [&](double dt, int count) {
    return radius(phase(solve(pendulum(Integrator::forward_euler, dt, count, c), {})));
  };
  EXPECT_LT(end(0.9 * limit, 2000), 0.1 * start);
  EXPECT_GT(end(1.2 * limit, 200), 2 * start);  // (1 - 2 zeta w dt + (w dt)^2)^100 = 1.0096^100 = 2.6
}

TEST(Pendulum, SymplecticEulerIsBoundedBelowItsLimit) {
  const Outcome outcome = solve(pendulum(Integrator::symplectic_euler, 0.5 / omega, 1000), {});
  // v^2 - w dt (w z) v + (w z)^2 is kept: between 1 -+ w dt/2 of the circle.
  EXPECT_LT(radius(phase(outcome)), start * std::sqrt(1 / (1 - 0.25)) * (1 + 1e-9));
  EXPECT_GT(radius(phase(outcome)), start * std::sqrt(1 / (1 + 0.25)) * (1 - 1e-9));
}

TEST(Pendulum, KeepsItsEnergyWhenItSwings) {
  Model model = pendulum(Integrator::newmark, 0.002, 1000);
  Mesh mesh = *model.mesh;
  mesh.points << 1, 0, 0;
  model.mesh = std::make_shared<const Mesh>(mesh);
  double largest = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    const Energies& e = state.energies;
    largest = std::max(largest, std::abs(e.elastic + e.kinetic - e.external_work));
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_LT(largest, 2e-3 * mass * weight);  // of the energy of a fall by the rest length; of order dt^2
  EXPECT_GT(outcome.state.energies.kinetic + outcome.state.energies.elastic, 0);
}

// Two springs of stiffness 2 and 6 hold a particle between points at x = 0 and x = 4, both without rest length: it
// rests at 6 4/(2 + 6) = 3, a way of 1 from its place at x = 2.
TEST(Springs, MoveABodyThatNothingElseLoads) {
  for (const Integrator integrator : {Integrator::static_, Integrator::quasi_static}) {
    Model model = particles(row(2, 0, 0), {1});
    model.steps[0].springs = {{.name = "a", .first = 0, .stiffness = 2},
                              {.name = "b", .first = 0, .point = Vec3(4, 0, 0), .stiffness = 6}};
    model.settings.integrator = integrator;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_NEAR(outcome.state.displacement(0, 0), 1, 1e-8);
    EXPECT_LT(outcome.check.residual, 1e-8);
  }
}

// Springs at all nodes and no support: all forces are internal, and still they are what a residual is beside.
TEST(Springs, HoldABodyWhoseResidualIsMeasuredBesideThem) {
  Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet4), {.youngs_modulus = 100, .poisson_ratio = 0.3});
  for (int n = 0; n < model.mesh->point_count(); ++n)
    model.steps[0].springs.push_back(
        {.name = "hold", .first = n, .point = 1.3 * model.mesh->points.row(n).transpose(), .stiffness = 10});
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GT(outcome.check.load_scale, 1);
  EXPECT_LT(outcome.check.residual, 1e-8);
}

// k z = m g with k = 50 (1 + t) and a rest length of 1 - t/4, in equilibrium at each time. What changes the spring does
// the work int (k'/2 s^2 - k s l_0') dt with the stretch s = m g / k: (m g)^2/2 (1/k_0 - 1/k_1) and m g / 4 for the
// rest.
TEST(Springs, ThatChangeWithTimeHoldAWeightAndAreWorkedOn) {
  double errors[2];
  for (const int count : {20, 40}) {
    Model model = pendulum(Integrator::quasi_static, 1.0 / count, count);
    Spring& spring = model.steps[0].springs[0];
    spring.stiffness_at = [](double t) { return stiffness * (1 + t); };
    spring.rest_at = [](double t) { return 1 - t / 4; };
    State first;
    const Outcome outcome = solve(model, [&](const State& state) {
      const double sag = mass * weight / (stiffness * (1 + state.time)) - state.time / 4;
      if (state.time > 0) {
        EXPECT_NEAR(state.displacement(0, 2), -sag, 1e-10) << state.time;
      }
      if (state.increment == 1) first = state;
      return true;
    });
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const double t0 = first.time, force = mass * weight;
    const double lifted = outcome.state.displacement(0, 2) - first.displacement(0, 2);
    const double on_spring = force * force / (2 * stiffness) * (1 / (1 + t0) - 0.5) + force * (1 - t0) / 4;
    const double work = outcome.state.energies.external_work - first.energies.external_work;
    errors[count == 40] = std::abs(work - (on_spring - force * lifted)) / on_spring;
  }
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_LT(errors[1], errors[0] / 3);  // of second order; the first state is nearer to 0 with the shorter step
}

// One linear solve: m (v_1 - v_0) / dt = -m g - k(t_1) z_1, z_1 = z_0 + dt v_1.
TEST(Springs, ThatChangeWithTimeAreThoseOfTheEndOfTheStep) {
  const double dt = 0.1;
  Model model = pendulum(Integrator::implicit_euler, dt, 30);
  model.settings.newton_iterations = 1;
  model.steps[0].springs[0].stiffness_at = [](double t) { return stiffness * (1 + t); };
  double z = 0, v = 0;
  solve(model, [&](const State& state) {
    if (state.increment == 0) return true;
    const double k = stiffness * (1 + state.time);
    v = (v - dt * (weight + k / mass * z)) / (1 + k / mass * dt * dt);
    z += dt * v;
    EXPECT_NEAR(state.displacement(0, 2), z, 1e-12) << state.time;
    return true;
  });
}

// Newmark's energy is kept but for terms of second order in dt: what changes the spring is part of the work.
TEST(Springs, ThatChangeWithTimeLeaveTheEnergyBalanced) {
  double drift[2] = {0, 0};
  for (const int half : {0, 1}) {
    Model model = pendulum(Integrator::newmark, 0.01 / (1 + half), 100 * (1 + half));
    Spring& spring = model.steps[0].springs[0];
    spring.stiffness_at = [](double t) { return stiffness * (1 + std::sin(3 * t) / 2); };
    spring.rest_at = [](double t) { return 1 + t / 5; };
    solve(model, [&](const State& state) {
      const Energies& e = state.energies;
      drift[half] = std::max(drift[half], std::abs(e.elastic + e.kinetic - e.external_work));
      return true;
    });
  }
  EXPECT_LT(drift[0], 0.02 * mass * weight);
  EXPECT_LT(drift[1], 0.3 * drift[0]);
}

}  // namespace
}  // namespace msml::fe
