// SPDX-License-Identifier: GPL-3.0-or-later
// Motion against exact oscillators, free fall, energy and momentum.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <tuple>
#include <utility>

#include "msml/core/error.hpp"
#include "solver/check_answer.hpp"
#include "solver/equations.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;

TEST(ImplicitEuler, IsOfFirstOrderInTime) {
  for (const bool lumped : {false, true}) {
    const double order = std::log2(error_at_end(Integrator::implicit_euler, lumped, 400) /
                                   error_at_end(Integrator::implicit_euler, lumped, 800));
    EXPECT_NEAR(order, 1, 0.05);
  }
}

TEST(Newmark, IsOfSecondOrderInTime) {
  for (const bool lumped : {false, true}) {
    const double order =
        std::log2(error_at_end(Integrator::newmark, lumped, 50) / error_at_end(Integrator::newmark, lumped, 100));
    EXPECT_NEAR(order, 2, 0.05);
  }
}

TEST(GeneralizedAlpha, IsOfSecondOrderInTime) {
  for (const bool lumped : {false, true}) EXPECT_NEAR(order_in_time(Integrator::generalized_alpha, lumped, 50), 2, 0.1);
  EXPECT_NEAR(order_in_time(Integrator::generalized_alpha, false, 100, 1.0, 0.005), 2, 0.15);
}

// At dt far above the period one step multiplies the amplitude by the spectral radius, a double eigenvalue: after n
// steps radius^n times a factor linear in n.
TEST(GeneralizedAlpha, DampsTheHighestFrequenciesByTheSpectralRadius) {
  const Oscillator o = oscillator(false);
  const double dt = 1e4 * o.period();
  for (const double radius : {0.5, 0.8, 0.95}) {
    const std::size_t first = radius < 0.6 ? 20 : 40;
    Model model = oscillator_model(Integrator::generalized_alpha, false, dt, static_cast<int>(2 * first));
    model.settings.spectral_radius = radius;
    std::vector<double> u;
    const Outcome outcome = solve(model, [&](const State& state) {
      u.push_back(std::hypot(state.displacement(3, 2) - 0.1 / o.k, state.velocity(3, 2) * dt));
      return true;
    });
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const double steps = static_cast<double>(first), rate = std::pow(u[2 * first] / u[first], 1 / steps);
    EXPECT_GT(rate, 0.98 * radius);
    EXPECT_LT(rate, 1.02 * radius * std::pow(2, 1 / steps));
  }
}

TEST(Newmark, WithOtherNumbersHasTheOrdersOfTheory) {
  const auto order = [](double beta, double gamma) {
    double error[2];
    for (const int fine : {0, 1}) {
      const Oscillator o = oscillator(true);
      const int count = 200 * (1 + fine);
      Model model = oscillator_model(Integrator::newmark, true, 0.6 * o.period() / count, count);
      model.settings.newmark_beta = beta;
      model.settings.newmark_gamma = gamma;
      model.settings.allow_unstable = true;
      error[fine] = std::abs(solve(model, {}).state.displacement(3, 2) - 0.1 / o.k * (1 - std::cos(1.2 * M_PI)));
    }
    return std::log2(error[0] / error[1]);
  };
  EXPECT_NEAR(order(1.0 / 6, 0.5), 2, 0.05);  // linear acceleration
  EXPECT_NEAR(order(0.3025, 0.6), 1, 0.15);   // numerical damping costs an order
}

TEST(Newmark, NumbersThatGrowWithoutBoundAreRefused) {
  Model model = oscillator_model(Integrator::newmark, true, 0.1, 1);
  model.settings.newmark_beta = 1.0 / 6;
  EXPECT_THROW(solve(model, {}), Error);
  model.settings.newmark_beta = 0.25;
  model.settings.newmark_gamma = 0.45;
  EXPECT_THROW(solve(model, {}), Error);
}

TEST(RayleighDamping, FollowsTheExactDampedOscillator) {
  for (const auto& [alpha, beta] : {std::pair{2.0, 0.0}, {0.0, 0.01}, {1.0, 0.005}}) {
    const double coarse = error_at_end(Integrator::newmark, false, 50, alpha, beta);
    const double fine = error_at_end(Integrator::newmark, false, 100, alpha, beta);
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << alpha << " " << beta;
    EXPECT_LT(fine, 2e-3);
    EXPECT_NEAR(std::log2(error_at_end(Integrator::implicit_euler, false, 400, alpha, beta) /
                          error_at_end(Integrator::implicit_euler, false, 800, alpha, beta)),
                1, 0.1);
  }
}

// Half of the mass of a unit cube with lumped corners moves: the four nodes at x = 0 are held.
TEST(InitialVelocity, IsNotThatOfHeldNodes) {
  for (const Integrator integrator : {Integrator::newmark, Integrator::central_difference}) {
    Model model = make_model(unit_mesh(1, CellKind::tet4), {.youngs_modulus = 1, .poisson_ratio = 0}, 1);
    model.settings.integrator = integrator;
    model.settings.lumped_mass = true;
    model.steps[0].dt = 1e-3;
    const auto held = points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
    model.steps[0].prescribed = {fix(held)};
    model.initial_velocity = Points::Zero(model.mesh->points.rows(), 3);
    model.initial_velocity.col(0).setOnes();
    bool start = true;
    const Outcome outcome = solve(model, [&](const State& state) {
      if (std::exchange(start, false)) {
        for (const int n : held) EXPECT_EQ(state.velocity(n, 0), 0);
        EXPECT_NEAR(state.energies.kinetic, 0.25, 1e-12);
      }
      return true;
    });
    ASSERT_EQ(outcome.notes.size(), 1u);
    EXPECT_EQ(outcome.notes[0], "the initial velocity is left out where supports hold the body: at 4 nodes");
  }
}

// A stiff cube that spins freely about its middle, a hundred steps of 0.02 rad: its stiffness damps changes of shape,
// of which there are 1e-5 (rho w^2 L^2 / E). K of the start of each step takes 80 % of the energy.
TEST(RayleighDamping, LeavesARigidRotationAlone) {
  Model model = make_model(unit_mesh(1, CellKind::tet4), {.youngs_modulus = 1e5, .poisson_ratio = 0.3}, 1);
  Step& step = model.steps[0];
  step.dt = 0.02;
  step.count = 100;
  model.initial_velocity = Points::Zero(model.mesh->points.rows(), 3);
  for (int n = 0; n < model.mesh->point_count(); ++n)
    model.initial_velocity.row(n) << 0.5 - model.mesh->points(n, 1), model.mesh->points(n, 0) - 0.5, 0;
  const auto kept = [&model](double beta) {
    model.settings.damping_stiffness = beta;
    double first = 0;
    const Outcome outcome = solve(model, [&](const State& state) {
      if (state.increment == 0) first = state.energies.kinetic;
      return true;
    });
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    return outcome.state.energies.kinetic / first;
  };
  // K of a law in terms of F holds the turning of its stress, K x_dot = w x f_int with f_int = w^2 M r: a power of
  // 2 beta w^2 times the kinetic energy, here over two units of time. The stiffness that turns without stress has none.
  const double turning_stress = std::exp(-4e-3);
  for (const auto& [integrator, law, left] : {std::tuple{Integrator::newmark, model.regions[0].law, 1.0},
                                              {Integrator::generalized_alpha, model.regions[0].law, 1.0},
                                              {Integrator::newmark, neo_hookean("log", 1e5, 0.3), turning_stress}}) {
    model.settings.integrator = integrator;
    model.regions[0].law = law;
    EXPECT_NEAR(kept(1e-3) / kept(0), left, 2e-5) << law->name();
  }
}

TEST(ImplicitEuler, DampsTheLowestPeriodAsTheCheckSays) {
  const Oscillator o = oscillator(false);
  const int per_cycle = 40;
  Model model = oscillator_model(Integrator::implicit_euler, false, o.period() / per_cycle, 10 * per_cycle);
  std::vector<double> u;
  const Outcome outcome = solve(model, [&](const State& state) {
    u.push_back(state.displacement(3, 2) - 0.1 / o.k);
    return true;
  });
  EXPECT_NEAR(outcome.check.lowest_period, o.period(), 1e-6 * o.period());
  // Largest swing in the second and in the seventh cycle: five cycles of the (slightly longer) discrete period.
  const auto peak = [&](int cycle) {
    double largest = 0;
    for (int k = 0; k < per_cycle; ++k)
      largest = std::max(largest, std::abs(u[static_cast<std::size_t>(cycle * per_cycle + k)]));
    return largest;
  };
  const double measured = 1 - std::pow(peak(6) / peak(1), 1.0 / 5);
  EXPECT_NEAR(outcome.check.damped_per_cycle, measured, 0.03);
  EXPECT_GT(measured, 0.3);
}

TEST(Newmark, KeepsTheEnergyOfALinearBody) {
  const Oscillator o = oscillator(false);
  const Model model = oscillator_model(Integrator::newmark, false, o.period() / 15, 500);
  double worst = 0;
  solve(model, [&](const State& state) {
    // Kinetic + elastic - work of the constant force = 0 from rest.
    const double v = state.velocity(3, 2), u = state.displacement(3, 2);
    worst = std::max(worst, std::abs(0.5 * o.m * v * v + 0.5 * o.k * u * u - 0.1 * u));
    return true;
  });
  EXPECT_LT(worst, 1e-10 * 0.1 * 0.1 / o.k);
}

TEST(Newmark, KeepsTheEnergyOfASwingingBeamNearly) {
  Model model = beam_model(2, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.integrator = Integrator::newmark;
  model.steps[0].dt = 0.005;
  model.steps[0].count = 100;
  const Equations equations(model);
  double largest = 0, drift = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    const Vector u = to_vector(equations.numbering(), state.displacement),
                 v = to_vector(equations.numbering(), state.velocity);
    Vector force = Vector::Zero(u.size()), Mv;
    multiply(equations.mass(), v, Mv);
    const double work = u.dot(equations.loads(0).dead);
    const double elastic = equations.elements().add_internal(u, Want::stress, force, nullptr).energy;
    largest = std::max(largest, std::abs(work));
    drift = std::max(drift, std::abs(elastic + 0.5 * v.dot(Mv) - work));
    return true;
  });
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  std::cout << "Newmark, swinging beam, 100 steps: energy drift " << drift / largest << " of the largest work\n";
  EXPECT_LT(drift, 0.02 * largest);
  EXPECT_LT(outcome.check.balance, 1e-6);
}

TEST(Dynamics, AFreeBodyFallsWithoutStrain) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10})
    for (const bool lumped : {false, true})
      for (const int iterations : {1, 25}) {
        Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, kind), {}, 7);
        model.settings.integrator = Integrator::newmark;
        model.settings.lumped_mass = lumped;
        model.settings.newton_iterations = iterations;
        model.steps[0].gravity = Vec3(1, 2, -10);
        model.steps[0].dt = 0.1;
        model.steps[0].count = 20;
        const Outcome outcome = solve(model, {});
        ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
        // The average acceleration method is exact for g t^2 / 2 = 2 g.
        for (int n = 0; n < model.mesh->point_count(); ++n)
          EXPECT_LT((outcome.state.displacement.row(n) - 2 * Eigen::RowVector3d(1, 2, -10)).norm(), 1e-8);
        EXPECT_EQ(outcome.check.lowest_period, 0);  // nothing holds it
        EXPECT_LT(outcome.check.largest_strain, 1e-8);
      }
}

TEST(Dynamics, PrescribedMotionHasItsVelocityAndPushesBack) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1e4}, 6);
  std::vector<int> all;
  for (int n = 0; n < 8; ++n) all.push_back(n);
  model.steps[0].prescribed = {{.name = "move", .nodes = all, .values = {Vec3(2, 0, 0)}}};
  model.steps[0].dt = 0.1;
  model.steps[0].count = 4;
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark}) {
    model.settings.integrator = integrator;
    std::vector<State> states;
    const Outcome outcome = solve(model, [&](const State& state) { return states.push_back(state), true; });
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_NEAR(states[2].displacement(0, 0), 1, 1e-12);
    EXPECT_NEAR(states[2].velocity(5, 0), 5, 1e-12);
    EXPECT_NEAR(states[2].acceleration.norm(), 0, 1e-9);
    // The first step takes the body from rest to speed 5 in 0.1: mass 6 times 50.
    EXPECT_NEAR(states[1].reaction.col(0).sum(), 300, 1e-8);
  }
}

TEST(Dynamics, ReactionsLoadsInertiaAndDampingBalance) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark, Integrator::generalized_alpha})
    for (const int iterations : {1, 25}) {
      Model model = beam_model(2, CellKind::tet10, 0.3, Strain::corotated);
      model.settings.integrator = integrator;
      model.settings.newton_iterations = iterations;
      model.settings.damping_mass = 0.5;
      model.settings.damping_stiffness = 0.01;
      model.steps[0].dt = 0.01;
      model.steps[0].count = 10;
      const Outcome outcome = solve(model, {});
      ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
      // One solve per step leaves the change of the tangent over a step in the residual.
      EXPECT_LT(outcome.check.balance, iterations == 1 ? 0.02 : 1e-6);
      EXPECT_NEAR(outcome.check.sum_loads[2], -9.81 * 1000 * 0.1 * 0.02 * 0.02, 1e-9);
    }
}

TEST(Dynamics, SettlesInTheStaticState) {
  Model model = beam_model(1, CellKind::tet10, 0.3, Strain::corotated);
  const Outcome rest = solve(model, {});
  model.settings.integrator = Integrator::implicit_euler;
  model.steps[0].dt = 0.2;
  model.steps[0].count = 60;
  const Outcome settled = solve(model, {});
  EXPECT_LT((rest.state.displacement - settled.state.displacement).norm(), 1e-6 * rest.state.displacement.norm());
}

// E = 1e6, rho = 1000, L = 10, h = .5: Euler and Bernoulli's first bending frequency of the cantilever is .0255417 Hz.
TEST(Dynamics, TheLowestPeriodIsThatOfTheBendingBeam) {
  for (const bool lumped : {false, true}) {
    Model model = make_model(box_mesh(20, 2, 2, {10, 0.5, 0.5}, CellKind::tet10),
                             {.youngs_modulus = 1e6, .poisson_ratio = 0.3, .strain = Strain::small}, 1000);
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.settings.integrator = Integrator::newmark;
    model.settings.lumped_mass = lumped;
    const Outcome outcome = solve(model, {});
    EXPECT_NEAR(1 / outcome.check.lowest_period, 0.0255417, 0.01 * 0.0255417);
  }
}

// The second bending frequency of the same beam is .1600673 Hz. Sideways motion is held, as the section is square; with
// nu = 0 that costs nothing. Inverse iteration, orthogonal to the first mode with respect to the mass.
TEST(Dynamics, TheSecondFrequencyIsThatOfTheBendingBeam) {
  for (const bool lumped : {false, true}) {
    Model model = make_model(box_mesh(20, 1, 2, {10, 0.5, 0.5}, CellKind::tet10),
                             {.youngs_modulus = 1e6, .poisson_ratio = 0, .strain = Strain::small}, 1000);
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3&) { return true; }), false, true, false),
                                 fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.settings.integrator = Integrator::newmark;
    model.settings.lumped_mass = lumped;
    const Equations equations(model);
    BlockMatrix K(equations.elements().pattern());
    Forces forces;
    equations.evaluate(Vector::Zero(equations.size()), {}, Want::tangent, forces, &K);
    const auto linear = make_cholesky(1);
    const Mask fixed = make_supports(model.steps[0], equations.numbering(), Vector::Zero(equations.size())).fixed;
    ASSERT_EQ(linear->factor(K, fixed), LinearStatus::done);
    std::vector<Vector> modes;
    std::vector<double> frequencies;
    for (int mode = 0; mode < 2; ++mode) {
      Vector x = Vector::LinSpaced(equations.size(), 1, 2), Mx, y;
      double square = 0;
      for (int iteration = 0; iteration < 40; ++iteration) {
        multiply(equations.mass(), x, Mx);
        linear->solve(Mx, 1e-10, y);
        for (const Vector& known : modes) {
          multiply(equations.mass(), known, Mx);
          y -= y.dot(Mx) * known;
        }
        multiply(equations.mass(), y, Mx);
        x = y / std::sqrt(y.dot(Mx));
        multiply(K, x, y);
        square = x.dot(y);
      }
      modes.push_back(x);
      frequencies.push_back(std::sqrt(square) / (2 * M_PI));
    }
    EXPECT_NEAR(frequencies[0], 0.0255417, 0.01 * 0.0255417);
    EXPECT_NEAR(frequencies[1], 0.1600673, 0.03 * 0.1600673);
  }
}

TEST(Dynamics, LoadsOfTheNextStepReplaceThoseBefore) {
  Model model = oscillator_model(Integrator::implicit_euler, true, 1, 400);
  model.steps.push_back(model.steps[0]);
  model.steps[1].forces[0].values[0] *= -2;
  const Outcome outcome = solve(model, {});
  EXPECT_NEAR(outcome.state.displacement(3, 2), -0.2 / oscillator(true).k, 1e-9);
  EXPECT_EQ(outcome.state.increment, 800);
  EXPECT_NEAR(outcome.state.time, 800, 1e-9);
}

// Supports alone move it, so that nothing pulls when the first step begins; one linear solve then leaves a residual.
TEST(Newmark, OneSolvePerStepStartsFromRestByItsSupports) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1000});
  const auto at = [&](double x) {
    return points_where(*model.mesh, [=](const Vec3& X) { return std::abs(X[0] - x) < 1e-9; });
  };
  model.steps[0].prescribed = {fix(at(0)), fix(at(1), true, false, false)};
  model.steps[0].prescribed[1].function = [](const Vec3&, double t) { return Vec3(0.01 * t, 0, 0); };
  model.steps[0].dt = 0.001;
  model.steps[0].count = 3;
  model.settings.integrator = Integrator::newmark;
  model.settings.newton_iterations = 1;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
}

}  // namespace
}  // namespace msml::fe
