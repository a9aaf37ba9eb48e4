// SPDX-License-Identifier: GPL-3.0-or-later
// What runs of incompressible bodies begin with: pressures, accelerations, and motions that keep volumes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "msml/core/error.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

constexpr double density = 3;

std::shared_ptr<const Law> incompressible() {
  return law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"incompressible", true}, {"poissonRatio", Value{}}});
}

Model body_of(Mesh mesh, double dt = 1e-3) {
  Model model = make_model(std::move(mesh), {}, density);
  model.regions[0].law = incompressible();
  model.formulation = Formulation::mixed;
  model.settings.integrator = Integrator::generalized_alpha;
  model.settings.tolerance = 1e-12;
  model.steps[0].dt = dt;
  return model;
}

Model block(double dt = 1e-3) { return body_of(unit_mesh(2, CellKind::tet10), dt); }

Slide wall(const Mesh& mesh, int axis, double place) {
  return {.name = "wall",
          .nodes = points_where(mesh, [=](const Vec3& x) { return std::abs(x[axis] - place) < 1e-9; }),
          .normal = Vec3::Unit(axis)};
}

Points field(const Mesh& mesh, const std::function<Vec3(const Vec3&)>& value) {
  Points points(mesh.point_count(), 3);
  for (int n = 0; n < mesh.point_count(); ++n) points.row(n) = value(mesh.points.row(n).transpose()).transpose();
  return points;
}

/// The state that a run begins with, and what is said of it.
Outcome first(const Model& model) {
  return solve(model, [](const State&) { return false; });
}

double furthest(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff(); }

double furthest_pressure(const Mesh& mesh, const State& state, const std::function<double(const Vec3&)>& expected) {
  double furthest = 0;
  for (int n = 0; n < mesh.point_count(); ++n)
    furthest = std::max(
        furthest, std::abs(state.pressure[static_cast<std::size_t>(n)] - expected(mesh.points.row(n).transpose())));
  return furthest;
}

// Between walls and on a floor nothing can move: p = rho g (1 - Z).
TEST(IncompressibleStart, AColumnBetweenWallsBeginsWithThePressureOfItsWeight) {
  Model model = block();
  model.steps[0].gravity = Vec3(0, 0, -10);
  for (const auto& [axis, place] : {std::pair{0, 0.0}, {0, 1.0}, {1, 0.0}, {1, 1.0}, {2, 0.0}})
    model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
  const State state = first(model).state;
  EXPECT_LT(state.acceleration.cwiseAbs().maxCoeff(), 1e-10 * 10);
  const auto weight = [](const Vec3& X) { return density * 10 * (1 - X[2]); };
  EXPECT_LT(furthest_pressure(*model.mesh, state, weight), 1e-10 * density * 10);
}

// The balance of generalised alpha looks back on the start of the step: a jump of the load must be in the pressure
// there.
TEST(IncompressibleStart, APressureJumpsWithItsLoadFromStepToStep) {
  for (const bool relaxes : {false, true}) {
    Model model = block();
    if (relaxes) model.regions[0].prony = {{0.5}, {0.01}};
    for (const auto& [axis, place] : {std::pair{0, 0.0}, {0, 1.0}, {1, 0.0}, {1, 1.0}, {2, 0.0}})
      model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
    model.steps.push_back(model.steps[0]);
    model.steps[0].gravity = Vec3(0, 0, -10);
    model.steps[1].gravity = Vec3(0, 0, 30);
    model.steps[0].count = model.steps[1].count = 2;
    const Outcome outcome = solve(model, [&](const State& state) {
      const double g = state.increment <= 2 ? 10 : -30;
      const auto weight = [&](const Vec3& X) { return density * g * (1 - X[2]); };
      EXPECT_LT(furthest_pressure(*model.mesh, state, weight), 1e-8 * density * 10) << state.increment << relaxes;
      EXPECT_LT(state.acceleration.cwiseAbs().maxCoeff(), 1e-8 * 10) << state.increment << relaxes;
      return true;
    });
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  }
}

// A piston of its own material: a = P / (rho L) everywhere, and p = P (1 - X / L).
TEST(IncompressibleStart, ALoadOnAFaceBetweenWallsPushesAllAlike) {
  Model model = block();
  for (const auto& [axis, place] : {std::pair{1, 0.0}, {1, 1.0}, {2, 0.0}, {2, 1.0}})
    model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
  FaceLoad load{.name = "push", .pressures = {12}};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  model.steps[0].face_loads = {load};
  const State state = first(model).state;
  EXPECT_LT(furthest(state.acceleration, field(*model.mesh, [](const Vec3&) { return Vec3(12 / density, 0, 0); })),
            1e-10);
  EXPECT_LT(furthest_pressure(*model.mesh, state, [](const Vec3& X) { return 12 * (1 - X[0]); }), 1e-10 * 12);
}

// v = g (X, 0, -Z) keeps volumes now, but goes on doing so only with div a = tr (grad v)^2 = 2 g^2: by forces
// rho a + grad p of a = (2 g^2 X, 0, 0) and p = q (1 - X), which is zero at the free face.
TEST(IncompressibleStart, AMotionGoesOnKeepingVolumes) {
  constexpr double g = 5, q = 7;
  Model model = block();
  for (const auto& [axis, place] : {std::pair{0, 0.0}, {1, 0.0}, {1, 1.0}, {2, 0.0}})
    model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
  model.initial_velocity = field(*model.mesh, [](const Vec3& X) { return Vec3(g * X[0], 0, -g * X[2]); });
  BodyForce force{.name = "f"};
  force.function = [](const Vec3& X, double) { return Vec3(density * 2 * g * g * X[0] - q, 0, 0); };
  force.elements = model.regions[0].elements;
  model.steps[0].body_forces = {force};
  FaceLoad load{.name = "top"};
  load.pressure_function = [](const Vec3& X, double) { return q * (1 - X[0]); };
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[2] > 1 - 1e-9; });
  model.steps[0].face_loads = {load};
  const Outcome outcome = first(model);
  const State& state = outcome.state;
  const Points expected = field(*model.mesh, [](const Vec3& X) { return Vec3(2 * g * g * X[0], 0, 0); });
  EXPECT_LT(furthest(state.acceleration, expected), 1e-9 * 2 * g * g);
  EXPECT_LT(furthest_pressure(*model.mesh, state, [](const Vec3& X) { return q * (1 - X[0]); }), 1e-8);
  EXPECT_LT(furthest(state.velocity, model.initial_velocity), 1e-12 * g);
}

// All faces but X = 1 are turned about the axis (0, 0, 1) at the origin. With forces -rho w^2 r no pressure is needed.
TEST(IncompressibleStart, ASpinOfTheSupportsPullsAllInwards) {
  constexpr double w = 4;
  Model model = block();
  Prescribed turn{.name = "turn", .values = {Vec3::Zero()}};
  turn.nodes =
      points_where(*model.mesh, [](const Vec3& x) { return x.minCoeff() < 1e-9 || x.tail(2).maxCoeff() > 1 - 1e-9; });
  turn.function = [](const Vec3& X, double t) { return Vec3(Eigen::AngleAxisd(w * t, Vec3::UnitZ()) * X - X); };
  model.steps[0].prescribed = {turn};
  model.initial_velocity = field(*model.mesh, [](const Vec3& X) { return Vec3(-w * X[1], w * X[0], 0); });
  BodyForce force{.name = "f"};
  force.function = [](const Vec3& X, double) { return Vec3(-density * w * w * X[0], -density * w * w * X[1], 0); };
  force.elements = model.regions[0].elements;
  model.steps[0].body_forces = {force};
  const State state = first(model).state;
  const Points expected = field(*model.mesh, [](const Vec3& X) { return Vec3(-w * w * X[0], -w * w * X[1], 0); });
  // One-sided differences over a tenth of dt: 11/12 (w h)^2 of the supports' acceleration.
  EXPECT_LT(furthest(state.acceleration, expected), 1e-5 * w * w);
  EXPECT_LT(furthest(state.velocity, model.initial_velocity), 2e-7 * w);  // and (w h)^2 / 3 of their velocity
  EXPECT_LT(furthest_pressure(*model.mesh, state, [](const Vec3&) { return 0.0; }), 1e-5 * density * w * w);
}

/// A block between walls that becomes longer and lower.
Model stretching(double dt, int count) {
  Model model = block(dt);
  model.steps[0].count = count;
  for (const auto& [axis, place] : {std::pair{0, 0.0}, {1, 0.0}, {1, 1.0}, {2, 0.0}})
    model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
  model.initial_velocity = field(*model.mesh, [](const Vec3& X) { return Vec3(5 * X[0], 0, -5 * X[2]); });
  return model;
}

double furthest(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

// Newmark's method forgets nothing: what the first state is wrong by swings on undamped, and is as large in every
// other state, whatever the step.
TEST(IncompressibleStart, PressuresAreOfSecondOrderInTimeFromThere) {
  std::vector<std::vector<double>> course[4];
  for (std::size_t fine = 0; fine < 4; ++fine) {
    Model model = stretching(0.0005 / (1 << fine), 4 << fine);
    model.settings.integrator = Integrator::newmark;
    solve(model, [&](const State& state) {
      course[fine].push_back(state.pressure);
      return true;
    });
  }
  for (const std::size_t time : {2, 4}) {
    const auto difference = [&](std::size_t k) { return furthest(course[k][time << k], course[k + 1][2 * time << k]); };
    // Of differences; those of the next pair of steps lie as much nearer to 2 again.
    EXPECT_NEAR(std::log2(difference(1) / difference(2)), 2, 0.15);
  }
  // The stress grows with 2 mu times the rate, by a half percent of the pressure in a step.
  const std::vector<double>& begin = course[3][0];
  EXPECT_LT(furthest(course[3][1], begin), 0.01 * furthest(begin, std::vector<double>(begin.size(), 0)));
}

/// The message that refuses a model; "" if it runs.
std::string refusal(const Model& model) {
  try {
    first(model);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Vec3 twisted(const Vec3& X, double angle) {
  const Vec3 axis(0.5, 0.5, 0);
  return axis + Eigen::AngleAxisd(angle * X[2], Vec3::UnitZ()) * (X - axis);
}

TEST(IncompressibleStart, RefusesDisplacementsThatChangeVolumes) {
  Model model = block();
  model.initial_displacement = field(*model.mesh, [](const Vec3& X) { return Vec3(0.3 * X[0], 0, 0); });
  const std::string message = refusal(model);
  EXPECT_THAT(message, ::testing::HasSubstr("initialDisplacement: it changes volumes"));
  EXPECT_THAT(message, ::testing::HasSubstr("by 0.3 of them, beside gradients of 0.3"));
}

// However small: it is its own gradient that it is measured by.
TEST(IncompressibleStart, RefusesVelocitiesThatChangeVolumesWhereTheyDo) {
  Model model = block();
  model.initial_velocity = field(*model.mesh, [](const Vec3& X) { return Vec3(1e-6 * X[0] * X[0], 7, 0); });
  const std::string message = refusal(model);
  EXPECT_THAT(message, ::testing::HasSubstr("initialVelocity: it changes volumes"));
  const std::size_t at = message.find("at (");
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(std::stod(message.substr(at + 4)), 0.5);  // X of the element: the divergence is 2e-6 X
}

TEST(IncompressibleStart, KeepsRigidMotionsAsTheyAre) {
  Model model = block();
  const Eigen::AngleAxisd turn(2, Vec3(1, 2, 3).normalized());
  model.initial_displacement = field(*model.mesh, [&](const Vec3& X) { return Vec3(turn * X - X + Vec3(1e4, 0, 0)); });
  model.initial_velocity =
      field(*model.mesh, [&](const Vec3& X) { return Vec3(1e-3 * Vec3(1, 2, 3).cross(turn * X)); });
  const Outcome outcome = first(model);
  EXPECT_TRUE(outcome.notes.empty());
  EXPECT_LT(furthest(outcome.state.velocity, model.initial_velocity), 1e-10);
}

// A twist keeps volumes, but its interpolation on the mesh does so only nearly: what is left is taken away, and less of
// it on a finer mesh.
TEST(IncompressibleStart, TakesAwayWhatTheMeshMakesOfATwist) {
  double change[2];
  for (const int n : {2, 4}) {
    Model model = body_of(unit_mesh(n, CellKind::tet10));
    model.initial_displacement = field(*model.mesh, [](const Vec3& X) { return Vec3(twisted(X, 0.6) - X); });
    model.initial_velocity = field(
        *model.mesh, [](const Vec3& X) { return Vec3((twisted(X, 0.6 + 1e-4) - twisted(X, 0.6 - 1e-4)) / 2e-4); });
    const Outcome outcome = first(model);
    EXPECT_THAT(outcome.notes, ::testing::Contains(::testing::HasSubstr("the initial displacement is changed by")));
    EXPECT_THAT(outcome.notes, ::testing::Contains(::testing::HasSubstr("the initial velocity is changed by")));
    change[n == 4] = furthest(outcome.state.displacement, model.initial_displacement);
    Model again = model;
    again.initial_displacement = outcome.state.displacement;
    again.initial_velocity = outcome.state.velocity;
    EXPECT_TRUE(first(again).notes.empty());
  }
  EXPECT_LT(change[1], change[0] / 4);
}

// A piston that starts at once drives all that is before it.
TEST(IncompressibleStart, SupportsThatMoveSetTheBodyOff) {
  Model model = block();
  for (const auto& [axis, place] : {std::pair{1, 0.0}, {1, 1.0}, {2, 0.0}, {2, 1.0}})
    model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
  Prescribed piston{.name = "piston", .values = {Vec3::Zero()}};
  piston.nodes = points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  piston.components[1] = piston.components[2] = false;
  piston.function = [](const Vec3&, double t) { return Vec3(0.3 * t + 5 * t * t, 0, 0); };
  model.steps[0].prescribed = {piston};
  const State state = first(model).state;
  EXPECT_LT(furthest(state.velocity, field(*model.mesh, [](const Vec3&) { return Vec3(0.3, 0, 0); })), 1e-9);
  EXPECT_LT(furthest(state.acceleration, field(*model.mesh, [](const Vec3&) { return Vec3(10, 0, 0); })), 1e-6);
  EXPECT_NEAR(state.reaction.col(0).sum(), density * 10, 1e-6);  // it pushes the whole mass
  EXPECT_LT(furthest_pressure(*model.mesh, state, [](const Vec3& X) { return density * 10 * (1 - X[0]); }), 1e-6);
}

// The same piston, which begins with the second step: its impulse sets all off there, and its work, with that of the
// impulse, is the kinetic energy that the body has.
TEST(IncompressibleStart, SupportsMaySetTheBodyOffInALaterStep) {
  for (const Integrator integrator : {Integrator::newmark, Integrator::generalized_alpha}) {
    Model model = block();
    model.settings.integrator = integrator;
    for (const auto& [axis, place] : {std::pair{1, 0.0}, {1, 1.0}, {2, 0.0}, {2, 1.0}})
      model.steps[0].slides.push_back(wall(*model.mesh, axis, place));
    model.steps[0].dt = 0.01;
    model.steps[0].count = 2;
    model.steps.push_back(model.steps[0]);
    Prescribed piston{.name = "piston", .values = {Vec3::Zero()}};
    piston.nodes = points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
    piston.components[1] = piston.components[2] = false;
    piston.function = [](const Vec3&, double t) { return Vec3(0.3 * (t - 0.02) + 5 * (t - 0.02) * (t - 0.02), 0, 0); };
    model.steps[1].prescribed = {piston};
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const State& state = outcome.state;
    EXPECT_LT(furthest(state.velocity, field(*model.mesh, [](const Vec3&) { return Vec3(0.5, 0, 0); })), 1e-6);
    EXPECT_LT(furthest_pressure(*model.mesh, state, [](const Vec3& X) { return density * 10 * (1 - X[0]); }),
              1e-4 * density * 10);
    EXPECT_NEAR(state.energies.kinetic, density * 0.125, 1e-6 * density);
    EXPECT_NEAR(state.energies.external_work, state.energies.kinetic, 1e-6 * density);
  }
}

// Vortices that keep volumes, on meshes that give a fifth of a wave to an element: what the mesh makes of them is taken
// away, and what is left is that field to 3 %.
TEST(IncompressibleStart, TakesFieldsThatCoarseMeshesChange) {
  Model model = body_of(unit_mesh(4, CellKind::tet10));
  const auto vortex = [](const Vec3& X) {
    return Vec3(std::sin(std::numbers::pi * X[0]) * std::cos(std::numbers::pi * X[1]),
                -std::cos(std::numbers::pi * X[0]) * std::sin(std::numbers::pi * X[1]), 0);
  };
  model.initial_velocity = field(*model.mesh, vortex);
  const Outcome outcome = first(model);
  EXPECT_LT(furthest(outcome.state.velocity, model.initial_velocity), 0.03);
  EXPECT_THAT(outcome.notes, ::testing::Contains(::testing::HasSubstr("the initial velocity is changed by")));
}

// Any pressure will do: the start says so, and the first step ends there.
TEST(IncompressibleStart, ABodyHeldAllAroundHasNoPressureOfItsOwn) {
  Model model = body_of(unit_mesh(3, CellKind::tet10));
  model.steps[0].gravity = Vec3(0, 0, -10);
  model.steps[0].prescribed = {
      fix(points_where(*model.mesh, [](const Vec3& x) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; }))};
  const Outcome outcome = solve(model, {});
  EXPECT_THAT(outcome.notes,
              ::testing::Contains(::testing::HasSubstr("pressures of incompressible regions at its start "
                                                       "are not determined")));
  EXPECT_EQ(outcome.stop, Stop::singular);
  EXPECT_THAT(outcome.diagnosis, ::testing::HasSubstr("hold an incompressible region all around"));
}

}  // namespace
}  // namespace msml::fe
