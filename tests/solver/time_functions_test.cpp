// SPDX-License-Identifier: GPL-3.0-or-later
// Loads and supports as functions of position and time, and body forces.
#include <gtest/gtest.h>

#include "solver/equations.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

constexpr std::array kinds{CellKind::tet4, CellKind::tet10};

Vec3 total(const Vector& v) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < v.size(); k += 3) sum += v.segment<3>(k);
  return sum;
}

/// Sum of the loads of the first step at a share and a time.
Vec3 acting(const Model& model, double share, double time, bool leaving = false) {
  const Equations equations(model);
  const ActingLoads loads{&equations.loads(0), share, time, leaving};
  Vector force = Vector::Zero(equations.size());
  add_dead(loads, force);
  add_followers(loads, equations.positions(), Vector::Zero(equations.size()), force, nullptr);
  return total(force);
}

/// A box of 2 x 1 x 3; its top is at z = 3.
Model box(CellKind kind) { return make_model(box_mesh(2, 2, 2, {2, 1, 3}, kind), {.strain = Strain::small}, 5); }

std::vector<Face> top(const Model& model) {
  return faces_where(*model.mesh, [](const Vec3& x) { return x[2] > 3 - 1e-9; });
}

std::vector<int> all_elements(const Model& model) {
  std::vector<int> all(static_cast<std::size_t>(model.mesh->cell_count()));
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  return all;
}

TEST(TimeFunctions, FactorReplacesTheRamp) {
  Model model = box(CellKind::tet4);
  model.steps[0].forces = {{.name = "f", .nodes = {1, 2}, .values = {Vec3(1, 0, 2)}}};
  EXPECT_LT((acting(model, 0.25, 3) - 0.5 * Vec3(1, 0, 2)).norm(), 1e-14);
  model.steps[0].forces[0].factor = [](double t) { return t * t; };
  EXPECT_LT((acting(model, 0.25, 3) - 18 * Vec3(1, 0, 2)).norm(), 1e-13);
  EXPECT_EQ(acting(model, 0.25, 3, true).norm(), 0);  // of the step before: gone
}

TEST(TimeFunctions, NodalForceIsAFunctionOfPlaceAndTime) {
  Model model = box(CellKind::tet4);
  const int corner = nearest_point(*model.mesh, {2, 1, 3});
  model.steps[0].forces = {
      {.name = "f", .nodes = {corner}, .values = {}, .function = [](const Vec3& X, double t) { return Vec3(t * X); }}};
  EXPECT_LT((acting(model, 0.5, 4) - Vec3(8, 4, 12)).norm(), 1e-13);
}

// Over the top, 2 x 1: int X = 2, int X Y = 1, int X^2 = 8/3.
TEST(TimeFunctions, TractionIsIntegratedOverTheFace) {
  for (const CellKind kind : kinds) {
    Model model = box(kind);
    model.steps[0].face_loads = {{.name = "f", .faces = top(model), .traction_function = [](const Vec3& X, double t) {
                                    return Vec3(X[0] * t, X[0] * X[1], X[0] * X[0]);
                                  }}};
    EXPECT_LT((acting(model, 0.5, 3) - Vec3(6, 1, 8.0 / 3)).norm(), 1e-13);
    model.steps[0].face_loads[0].steady = true;  // ramps, at t = 0
    EXPECT_LT((acting(model, 0.5, 3) - 0.5 * Vec3(0, 1, 8.0 / 3)).norm(), 1e-13);
  }
}

TEST(TimeFunctions, PressureIsIntegratedOverTheFaceDeadOrFollowing) {
  for (const CellKind kind : kinds)
    for (const bool follower : {false, true}) {
      Model model = box(kind);
      model.steps[0].face_loads = {
          {.name = "f", .faces = top(model), .follower = follower, .pressure_function = [](const Vec3& X, double t) {
             return t * X[0] * X[1];
           }}};
      EXPECT_LT((acting(model, 0.5, 3) - Vec3(0, 0, -3)).norm(), 1e-13);
      model.steps[0].face_loads[0].factor = [](double) { return 2.0; };
      EXPECT_LT((acting(model, 0.5, 3) - Vec3(0, 0, -6)).norm(), 1e-13);
      EXPECT_EQ(acting(model, 0.5, 3, true).norm(), 0);
      model.steps[0].face_loads[0] = {
          .name = "f", .faces = top(model), .pressures = {4}, .follower = follower, .factor = [](double t) {
            return t;
          }};
      EXPECT_LT((acting(model, 0.5, 3) - Vec3(0, 0, -24)).norm(), 1e-12);
    }
}

// In the box, 2 x 1 x 3: int X = 6, int Y^2 = 2, volume 6.
TEST(BodyForce, IsIntegratedOverTheVolume) {
  for (const CellKind kind : kinds) {
    Model model = box(kind);
    model.steps[0].body_forces = {{.name = "b",
                                   .elements = all_elements(model),
                                   .function = [](const Vec3& X, double t) { return Vec3(X[0], X[1] * X[1], t); }}};
    EXPECT_LT((acting(model, 0.5, 3) - Vec3(6, 2, 18)).norm(), 1e-12);
    model.steps[0].body_forces[0].elements = {0};
    EXPECT_NEAR(acting(model, 0.5, 3)[2], 3 * 6.0 / 48, 1e-13);  // one of 48 equal tetrahedra
  }
}

TEST(BodyForce, OfTheWeightIsGravity) {
  for (const CellKind kind : kinds) {
    Model model = box(kind);
    model.steps[0].gravity = Vec3(1, 2, -9.81);
    const Vector weight = Equations(model).loads(0).dead;
    model.steps[0].gravity.setZero();
    model.steps[0].body_forces = {{.name = "b", .elements = all_elements(model), .value = 5 * Vec3(1, 2, -9.81)}};
    EXPECT_LT((Equations(model).loads(0).dead - weight).norm(), 1e-12 * weight.norm());
  }
}

TEST(TimeFunctions, SupportsFollowTimeAndTheLaterConditionWins) {
  const Model model = box(CellKind::tet4);
  const Equations equations(model);
  Step step;
  const int corner = nearest_point(*model.mesh, {2, 1, 3});
  step.prescribed = {
      {.name = "a", .nodes = {corner}, .values = {}, .function = [](const Vec3& X, double t) { return Vec3(t * X); }},
      {.name = "b",
       .nodes = {corner},
       .values = {Vec3(7, 7, 7)},
       .components = {false, true, false},
       .ramp = Ramp::step}};
  const Supports supports = make_supports(step, equations.numbering(), Vector::Zero(equations.size()));
  const int n = 3 * equations.numbering().number_of[static_cast<std::size_t>(corner)];
  EXPECT_LT((Vec3(supports.at(0.5, 2).segment<3>(n)) - Vec3(4, 7, 6)).norm(), 1e-14);
}

// A linear body: the displacement is the load's factor at the time of each state times that of the full load.
TEST(TimeFunctions, StaticStatesFollowTheLoadCurve) {
  Model model = box(CellKind::tet4);
  model.settings.integrator = Integrator::static_;
  Step& step = model.steps[0];
  step.prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; }))};
  step.face_loads = {{.name = "pull", .faces = top(model), .tractions = {Vec3(0, 0, 1)}}};
  const Points full = solve(model, {}).state.displacement;
  step.face_loads[0].factor = [](double t) { return std::sin(t); };
  step.dt = 0.1;
  step.count = 20;
  model.settings.load_steps = 4;
  std::vector<double> times;
  const Outcome outcome = solve(model, [&](const State& state) {
    times.push_back(state.time);
    EXPECT_LT((state.displacement - std::sin(state.time) * full).norm(), 1e-7 * full.norm());
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged);
  EXPECT_EQ(times, (std::vector<double>{0, 0.5, 1, 1.5, 2}));
}

/// One tetrahedron with unit edges along the axes; its node 3 moves along z, the others with b sin(W t). By hand, with
/// V = 1/6, k = V (lambda + 2 mu) and consistent mass m = rho V/10, 3 rho V/20 to the three others:
/// m z'' + 1.5 m u'' + k (z - u) = 0 from rest has z = A (sin W t - W/w sin w t), A = b (w^2 + 1.5 W^2)/(w^2 - W^2).
double error_of_driven_oscillator(Integrator integrator, int count) {
  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const int nodes[4] = {0, 1, 2, 3};
  mesh.add_cell(CellKind::tet4, nodes);
  constexpr double E = 100, nu = 0.25, rho = 3, b = 0.01;
  Model model = make_model(std::move(mesh), {.youngs_modulus = E, .poisson_ratio = nu, .strain = Strain::small}, rho);
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const double w = std::sqrt((lambda + 2 * mu) / 6 / (rho / 60)), W = 0.6 * w, end = 5 / w;
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-12;
  Step& step = model.steps[0];
  step.dt = end / count;
  step.count = count;
  step.prescribed = {{.name = "base",
                      .nodes = {0, 1, 2},
                      .values = {},
                      .function = [=](const Vec3&, double t) { return Vec3(0, 0, b * std::sin(W * t)); }},
                     fix({3}, true, true, false)};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double A = b * (w * w + 1.5 * W * W) / (w * w - W * W);
  return std::abs(outcome.state.displacement(3, 2) - A * (std::sin(W * end) - W / w * std::sin(w * end))) / b;
}

TEST(TimeFunctions, MovedSupportsKeepTheOrderOfTheMethod) {
  for (const Integrator integrator : {Integrator::newmark, Integrator::generalized_alpha, Integrator::implicit_euler}) {
    const double order = integrator == Integrator::implicit_euler ? 1 : 2;
    const double coarse = error_of_driven_oscillator(integrator, 100),
                 fine = error_of_driven_oscillator(integrator, 200);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.15) << name(integrator);
  }
}

}  // namespace
}  // namespace msml::fe
