// SPDX-License-Identifier: GPL-3.0-or-later
// Damping that changes with the shape of the body, in time steps: against solutions of the ordinary equations.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/oscillator.hpp"

namespace msml::fe {
namespace {

using namespace testing;

using Phase = Eigen::VectorXd;  // places, then velocities

/// The end of y' = rate(y, t) from y at t = 0 by the classical method of Runge and Kutta in 20,000 steps: errors of
/// 1e-12 in these tests.
Phase end_of(Phase y, double end, const std::function<Phase(const Phase&, double)>& rate) {
  const int count = 20000;
  const double h = end / count;
  for (int k = 0; k < count; ++k) {
    const double t = k * h;
    const Phase a = rate(y, t), b = rate(y + h / 2 * a, t + h / 2), c = rate(y + h / 2 * b, t + h / 2),
                d = rate(y + h * c, t + h);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

constexpr double shear = 500, pull = 600, damping_time = 0.005, bar_end = 0.1;

/// A bar of length, cross-section and density 1 as one element, held at x = 0, pulled at the other end from t = 0 on.
/// With Poisson's ratio 0 it keeps its width, and its force is mu (l - 1/l).
Model bar(Integrator integrator, int count) {
  Model model = make_model(segment_mesh(1, 1, CellKind::line2), {}, 1);
  model.regions[0].law = neo_hookean("log", 2 * shear, 0);
  model.settings.integrator = integrator;
  model.settings.lumped_mass = true;
  model.settings.tolerance = 1e-10;
  model.settings.damping_stiffness = damping_time;
  model.steps[0].dt = bar_end / count;
  model.steps[0].count = count;
  model.steps[0].prescribed = {fix({0})};
  model.steps[0].forces = {{.name = "pull", .nodes = {1}, .values = {Vec3(pull, 0, 0)}}};
  return model;
}

double bar_error(Integrator integrator, int count) {
  static const double exact = end_of(Phase::Zero(2), bar_end, [](const Phase& y, double) {
    const double l = 1 + y[0], force = shear * (l - 1 / l), stiffness = shear * (1 + 1 / (l * l));
    return Phase(Eigen::Vector2d(y[1], (pull - force - damping_time * stiffness * y[1]) / 0.5));
  })[0];
  const Outcome outcome = solve(bar(integrator, count), {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return outcome.state.displacement(1, 0) - exact;
}

// The error quarters where the time step halves, down to what Newton's tolerance leaves.
TEST(RayleighDamping, OfAStiffnessThatChangesKeepsSecondOrder) {
  for (const Integrator integrator :
       {Integrator::newmark, Integrator::generalized_alpha, Integrator::central_difference}) {
    double before = bar_error(integrator, 100);
    for (const int count : {200, 400, 800, 1600, 3200}) {
      const double now = bar_error(integrator, count);
      EXPECT_NEAR(std::log2(before / now), 2, 0.1) << name(integrator) << " " << count << ": " << now;
      before = now;
    }
  }
}

constexpr double stiffness = 50, damping = 0.8, weight = 9.81, swing_end = 2;

Model particles(const std::vector<Vec3>& places, Integrator integrator, double dt, int count) {
  Model model;
  Mesh mesh;
  mesh.points.resize(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t n = 0; n < places.size(); ++n) {
    mesh.points.row(static_cast<Eigen::Index>(n)) = places[n].transpose();
    model.point_masses.push_back({static_cast<int>(n), 1});
  }
  model.mesh = std::make_shared<const Mesh>(mesh);
  model.steps = {{.name = "s", .dt = dt, .count = count, .gravity = Vec3::Zero()}};
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-10;
  return model;
}

/// A mass of 1 on a damped spring of length 1, let go beside its fixed end; `varies`: the damper fades with time.
double swing_error(Integrator integrator, int count, double rest, bool varies) {
  const auto damper = [varies](double t) { return varies ? damping * (1 + std::cos(3 * t)) : damping; };
  const Phase exact = end_of(Eigen::Vector4d(1, 0, 0, 0), swing_end, [&](const Phase& y, double t) {
    const Eigen::Vector2d x = y.head(2), v = y.tail(2), d = x.normalized();
    const Eigen::Vector2d braked = rest > 0 ? Eigen::Vector2d(d.dot(v) * d) : v;
    const Eigen::Vector2d f = -stiffness * (x.norm() - rest) * d - damper(t) * braked - Eigen::Vector2d(0, weight);
    return Phase(Eigen::Vector4d(v[0], v[1], f[0], f[1]));
  });
  Model model = particles({Vec3(1, 0, 0)}, integrator, swing_end / count, count);
  model.steps[0].gravity = Vec3(0, -weight, 0);
  model.steps[0].springs = {{.name = "s", .first = 0, .stiffness = stiffness, .damping = damping, .rest = rest}};
  if (varies) model.steps[0].springs[0].damping_at = {damper};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return (outcome.state.displacement.row(0).head(2).transpose() + Eigen::Vector2d(1, 0) - exact.head(2)).norm();
}

TEST(Dampers, ThatTurnKeepSecondOrder) {
  for (const Integrator integrator :
       {Integrator::newmark, Integrator::generalized_alpha, Integrator::central_difference})
    for (const auto& [rest, varies] : {std::pair{1.0, false}, {1.0, true}, {0.0, true}}) {
      const double coarse = swing_error(integrator, 800, rest, varies);
      const double fine = swing_error(integrator, 1600, rest, varies);
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << name(integrator) << " " << rest << " " << varies << " " << fine;
    }
}

// The forces of a damper between two masses are opposite and on one line, so that their moments cancel.
TEST(Dampers, BetweenTwoMassesKeepTheirAngularMomentum) {
  for (const Integrator integrator : {Integrator::newmark, Integrator::generalized_alpha}) {
    const auto change = [&](int count) {
      Model model = particles({Vec3(0, 0, 0), Vec3(2, 0, 0)}, integrator, 1.0 / count, count);
      model.initial_velocity = Points::Zero(2, 3);
      model.initial_velocity.col(1) << 1, -1;
      model.steps[0].springs = {{.name = "s", .first = 0, .second = 1, .stiffness = 30, .damping = 0.5, .rest = 1.5}};
      const Outcome outcome = solve(model, {});
      EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
      return std::abs(outcome.state.energies.angular_momentum[2] + 2);
    };
    // Newmark's steps keep it to second order only where a spring turns, damped or not.
    const double coarse = change(200), fine = change(400);
    EXPECT_LT(coarse, 4e-4) << name(integrator);
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << name(integrator);
  }
}

// A mass that circles about the other end of its spring, by a fiftieth of a turn in each step and by half a turn.
TEST(Dampers, ThatTurnTooFarInAStepAreNamed) {
  for (const double dt : {0.126, 3.0}) {
    Model model = particles({Vec3(1, 0, 0)}, Integrator::newmark, dt, 10);
    model.initial_velocity = Points::Zero(1, 3);
    model.initial_velocity(0, 1) = 1;
    model.steps[0].springs = {{.name = "s", .first = 0, .stiffness = 2, .damping = 20, .rest = 1}};
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const bool told = std::ranges::any_of(outcome.warnings, [](const std::string& warning) {
      return warning.find("did not settle on those of the end of the step") != std::string::npos;
    });
    EXPECT_EQ(told, dt > 1) << dt;
  }
}

/// A cube in two symmetry planes, pulled, all of it turned by R: held by components where R is none.
Model in_planes(const Mat3& R, Integrator integrator) {
  const Mesh straight = unit_mesh(1, CellKind::tet4);
  Mesh mesh = straight;
  mesh.points = straight.points * R.transpose();
  Model model = make_model(std::move(mesh), {}, 1);
  model.regions[0].law = neo_hookean("log", 1000, 0.3);
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-11;
  model.settings.damping_stiffness = 0.01;
  Step& step = model.steps[0];
  step.dt = 0.005;
  step.count = 20;
  for (int c = 0; c < 2; ++c) {
    const auto nodes = points_where(straight, [c](const Vec3& x) { return x[c] < 1e-9; });
    if (R.isIdentity())
      step.prescribed.push_back(fix(nodes, c == 0, c == 1, false));
    else
      step.slides.push_back({.name = "plane", .nodes = nodes, .normal = R.col(c)});
  }
  step.face_loads = {{.name = "pull",
                      .faces = faces_where(straight, [](const Vec3& x) { return x[0] > 1 - 1e-9; }),
                      .tractions = {R * Vec3(100, 0, 20)}}};
  return model;
}

// Newton's tolerance, 1e-11 a step, over 20 steps and the condition of accelerations.
TEST(RayleighDamping, InObliquePlanesHasTheTurnedAnswer) {
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Integrator integrator : {Integrator::newmark, Integrator::generalized_alpha, Integrator::implicit_euler}) {
    const Outcome one = solve(in_planes(Mat3::Identity(), integrator), {}), two = solve(in_planes(R, integrator), {});
    ASSERT_EQ(one.stop, Stop::converged) << one.diagnosis;
    ASSERT_EQ(two.stop, Stop::converged) << two.diagnosis;
    const auto same = [&](const Points& a, const Points& b) {
      EXPECT_LT((a * R.transpose() - b).norm(), 1e-8 * a.norm()) << name(integrator);
    };
    same(one.state.displacement, two.state.displacement);
    same(one.state.acceleration, two.state.acceleration);
  }
}

}  // namespace
}  // namespace msml::fe
