// SPDX-License-Identifier: GPL-3.0-or-later
// Explicit methods: orders in time, and stable time steps against theory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "solver/equations.hpp"
#include "solver/stable_step.hpp"
#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr Integrator explicit_methods[] = {Integrator::forward_euler, Integrator::symplectic_euler,
                                           Integrator::central_difference};

/// Largest |u - f/k| over a run of `count` steps of dt, allowed to be unstable; f/k is where it would rest.
double swing(Integrator method, double dt, int count, double alpha, double beta) {
  Model model = oscillator_model(method, true, dt, count, 0);
  model.settings.damping_mass = alpha;
  model.settings.damping_stiffness = beta;
  model.settings.allow_unstable = true;
  model.steps[0].count = count;
  model.steps[0].forces = {{.name = "pull", .nodes = {3}, .values = {Vec3(0, 0, 0.1)}}};
  const double rest = 0.1 / oscillator(true).k;
  double last = 0;
  int k = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    if (++k > count - 40) last = std::max(last, std::abs(state.displacement(3, 2) - rest));
    return true;
  });
  return outcome.stop == Stop::converged ? last / rest : std::numeric_limits<double>::infinity();
}

TEST(Explicit, MethodsHaveTheirOrdersInTime) {
  EXPECT_NEAR(order_in_time(Integrator::symplectic_euler, true, 400), 1, 0.1);
  for (const auto& [alpha, beta] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {0.0, 0.01}, {1.0, 0.005}})
    EXPECT_NEAR(order_in_time(Integrator::central_difference, true, 200, alpha, beta), 2, 0.05) << alpha << " " << beta;
  EXPECT_NEAR(order_in_time(Integrator::forward_euler, true, 3000, 0, 0.02), 1, 0.1);
}

// Amplitudes stay below the limits of theory and grow above them; 2 % on either side, over 2000 steps.
TEST(Explicit, MeasuredStabilityLimitsAreThoseOfTheory) {
  const double w = oscillator(true).omega();
  for (const double zeta : {0.0, 0.1, 0.5}) {
    const double alpha = 2 * zeta * w;
    const double limits[] = {2 * (std::sqrt(1 + zeta * zeta) - zeta) / w, 2 / w};
    for (const auto& [method, limit] :
         {std::pair{Integrator::symplectic_euler, limits[0]}, {Integrator::central_difference, limits[1]}}) {
      EXPECT_NEAR(stable_step(method, w * w, alpha, 0), limit, 1e-12 * limit);
      EXPECT_LT(swing(method, 0.98 * limit, 2000, alpha, 0), 12) << zeta;
      EXPECT_GT(swing(method, 1.02 * limit, 2000, alpha, 0), 1e6) << zeta;
    }
    if (zeta == 0) continue;
    const double limit = 2 * zeta / w;
    EXPECT_NEAR(stable_step(Integrator::forward_euler, w * w, alpha, 0), limit, 1e-12 * limit);
    EXPECT_LT(swing(Integrator::forward_euler, 0.98 * limit, 2000, alpha, 0), 2) << zeta;
    EXPECT_GT(swing(Integrator::forward_euler, 1.02 * limit, 2000, alpha, 0), 2) << zeta;
  }
}

// The stiffness damps: c = beta w^2. Central differences lead the velocity on, which costs them of the step.
TEST(Explicit, MeasuredStabilityLimitsOfDampingByTheStiffnessAreThoseOfTheory) {
  const double w = oscillator(true).omega();
  for (const double zeta : {0.1, 0.5, 2.0})
    for (const auto& [method, z] :
         {std::pair{Integrator::symplectic_euler, zeta}, {Integrator::central_difference, 2 * zeta}}) {
      const double beta = 2 * zeta / w, limit = 2 * (std::sqrt(1 + z * z) - z) / w;
      EXPECT_NEAR(stable_step(method, w * w, 0, beta * w * w), limit, 1e-12 * limit);
      EXPECT_LT(swing(method, 0.98 * limit, 2000, 0, beta), 2) << zeta;
      EXPECT_GT(swing(method, 1.02 * limit, 2000, 0, beta), 1e6) << zeta;
      // Damping by the mass beside it changes the limit of the one that takes it at its own time no more.
      if (method == Integrator::central_difference) {
        EXPECT_LT(swing(method, 0.98 * limit, 2000, w, beta), 2) << zeta;
        EXPECT_GT(swing(method, 1.02 * limit, 2000, w, beta), 1e6) << zeta;
      }
    }
}

// |1 + i w dt| = sqrt(1 + w^2 dt^2) a step.
TEST(ForwardEuler, GrowsAtItsKnownRateWithoutDamping) {
  const double w = oscillator(true).omega(), dt = 0.1 / w;
  Model model = oscillator_model(Integrator::forward_euler, true, dt, 400);
  model.settings.allow_unstable = true;
  std::vector<double> energy;
  const Oscillator o = oscillator(true);
  solve(model, [&](const State& state) {
    const double x = state.displacement(3, 2) - 0.1 / o.k, v = state.velocity(3, 2);
    energy.push_back(0.5 * o.m * v * v + 0.5 * o.k * x * x);
    return true;
  });
  ASSERT_EQ(energy.size(), 401u);
  EXPECT_NEAR(std::log(energy[400] / energy[0]), 400 * std::log(1 + 0.01), 1e-9 * 400);
}

TEST(Explicit, ScenesThatAskForTooLargeAStepAreRefusedWithTheNumber) {
  const double w = oscillator(true).omega();
  for (const Integrator method : {Integrator::symplectic_euler, Integrator::central_difference}) {
    Model model = oscillator_model(method, true, 2.1 / w, 10);
    int states = 0;
    const Outcome outcome = solve(model, [&](const State&) { return ++states > 0; });
    EXPECT_EQ(outcome.stop, Stop::unstable_step);
    EXPECT_EQ(states, 0);
    EXPECT_NEAR(outcome.stable_step, 2 / w, 1e-6 / w);
    EXPECT_THAT(outcome.diagnosis, HasSubstr("is unstable above"));
    EXPECT_THAT(outcome.diagnosis, HasSubstr("allowUnstable"));
    model.steps[0].dt = 1.9 / w;
    EXPECT_EQ(solve(model, {}).stop, Stop::converged);
  }
  const Outcome outcome = solve(oscillator_model(Integrator::forward_euler, true, 1e-6 / w, 10), {});
  EXPECT_EQ(outcome.stop, Stop::unstable_step);
  EXPECT_THAT(outcome.diagnosis, HasSubstr("2 zeta/omega"));
}

// A damper of c = 2 zeta m w beside the oscillator: 4 - 2 (c/m) dt - w^2 dt^2 > 0, with 4 c instead of 2 c for central
// differences.
TEST(Explicit, DampersShortenTheStableStep) {
  const Oscillator o = oscillator(true);
  const double w = o.omega(), zeta = 0.5;
  for (const auto& [method, z] :
       {std::pair{Integrator::symplectic_euler, zeta}, {Integrator::central_difference, 2 * zeta}}) {
    const double limit = 2 * (std::sqrt(1 + z * z) - z) / w;
    Model model = oscillator_model(method, true, 1.05 * limit, 10);
    model.steps[0].springs = {
        {.name = "damper", .first = 3, .point = Vec3(0, 0, 2), .damping = 2 * zeta * o.m * w, .rest = 1}};
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::unstable_step);
    EXPECT_NEAR(outcome.stable_step, limit, 1e-6 * limit);
    model.steps[0].dt = 0.95 * limit;
    EXPECT_EQ(solve(model, {}).stop, Stop::converged);
  }
}

// The tangent grows under a pull that stretches a law stiffening with strain; here: an overflow is caught.
TEST(Explicit, AnExplosionEndsWithADiagnosisAndTheLastGoodState) {
  const double w = oscillator(true).omega();
  Model model = oscillator_model(Integrator::central_difference, true, 20 / w, 1000);
  model.settings.allow_unstable = true;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::diverged);
  EXPECT_TRUE(outcome.state.displacement.allFinite());
  EXPECT_THAT(outcome.diagnosis, HasSubstr("diverged"));
}

TEST(LargestEigenvalue, IsThatOfADenseSolver) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = beam_model(1, kind, 0.3, Strain::small);
    model.settings.integrator = Integrator::central_difference;
    const Equations equations(model);
    BlockMatrix K(equations.elements().pattern());
    Forces forces;
    equations.evaluate(Vector::Zero(equations.size()), {}, Want::tangent, forces, &K);
    const int n = equations.size();
    Eigen::MatrixXd dense(n, n);
    Vector column;
    for (int k = 0; k < n; ++k) {
      multiply(K, Vector::Unit(n, k), column);
      dense.col(k) = column;
    }
    const ScalarMatrix& M = equations.mass();
    for (int k = 0; k < n; ++k) {
      const double m =
          std::sqrt(M.values[static_cast<std::size_t>(M.pattern->diagonal[static_cast<std::size_t>(k / 3)])]);
      dense.row(k) /= m;
      dense.col(k) /= m;
    }
    const double exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues().maxCoeff();
    EXPECT_NEAR(largest_eigenvalue(K, M, Mask(static_cast<std::size_t>(n), 0)), exact, 1e-6 * exact);
  }
}

TEST(Explicit, AMovedSupportSetsOffWithItsVelocity) {
  for (const Integrator method : {Integrator::central_difference, Integrator::symplectic_euler}) {
    Model model = make_model(segment_mesh(4, 1, CellKind::line2), {.youngs_modulus = 100, .poisson_ratio = 0});
    model.settings.integrator = method;
    model.steps[0].dt = 1e-3;
    model.steps[0].count = 2;
    model.steps[0].gravity.setZero();
    model.steps[0].prescribed = {fix({0})};
    model.steps[0].prescribed[0].function = [](const Vec3&, double t) { return Vec3(0.1 * std::sin(10 * t), 0, 0); };
    std::vector<double> v, a;
    solve(model, [&](const State& state) {
      v.push_back(state.velocity(0, 0)), a.push_back(state.acceleration(0, 0));
      return true;
    });
    ASSERT_EQ(v.size(), 3u);
    EXPECT_NEAR(v[0], 1, 1e-3);
    EXPECT_LT(std::abs(a[1]), 1);  // -10 sin 10 t is 0.1 there; from rest it would be 1000
  }
}

TEST(Explicit, AFreeBodyFallsWithoutStrainAndKeepsItsMomentum) {
  for (const Integrator method : explicit_methods) {
    Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet10), {.youngs_modulus = 10}, 7);
    model.settings.integrator = method;
    model.settings.allow_unstable = method == Integrator::forward_euler;
    model.steps[0].gravity = Vec3(1, 2, -10);
    model.steps[0].dt = 0.01;
    model.steps[0].count = 100;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Vec3 p = 14 * Vec3(1, 2, -10);  // mass 14, time 1
    EXPECT_LT((outcome.state.energies.momentum - p).norm(), 1e-11 * p.norm());
    EXPECT_LT(outcome.check.largest_strain, 1e-8);
    EXPECT_LT(outcome.check.balance, 1e-10);
  }
}

// A mass hangs on a damped spring. Along it dt < 2 zeta/omega = c/k = 0.04 holds; across it nothing damps once the
// spring is stretched, and forward Euler lets a swing grow by 1 + g/(2 l) dt^2 a step, which is little in five seconds.
TEST(ForwardEuler, RunsADampedPendulumWhoseSwingGrowsLittle) {
  const auto hang = [](double dt, int count) {
    Model model;
    Mesh mesh;
    mesh.points.resize(1, 3);
    mesh.points << 0, 0, -1;
    model.mesh = std::make_shared<const Mesh>(mesh);
    model.point_masses = {{0, 2}};
    model.steps = {{.name = "swing", .dt = dt, .count = count}};
    model.steps[0].springs = {{.name = "s", .first = 0, .stiffness = 50, .damping = 2, .rest = 1}};
    model.settings.integrator = Integrator::forward_euler;
    return solve(model, {});
  };
  const Outcome fine = hang(0.001, 5000);
  EXPECT_EQ(fine.stop, Stop::converged) << fine.diagnosis;
  EXPECT_NEAR(fine.state.displacement(0, 2), -0.362083, 2e-2);  // exact; first order in dt
  EXPECT_EQ(fine.warnings.size(), 1u);
  EXPECT_EQ(hang(0.05, 100).stop, Stop::unstable_step);
}

}  // namespace
}  // namespace msml::fe
