// SPDX-License-Identifier: GPL-3.0-or-later
// Arc length beside springs, embedded meshes, plane stress and pressures that are unknowns, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// Runs along an arc; `check` sees each state but the first.
Outcome follow(const Model& model, const std::function<void(const State&)>& check) {
  int seen = 0;
  const Outcome outcome = solve(model, [&](const State& state) {
    check(state);
    seen += state.increment > 0;
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_GT(seen, 3);
  return outcome;
}

/// A particle at height 0.5 between springs of stiffness 100 to (-1, 0) and (1, 0), pressed down by 1.
Model shallow_truss() {
  Model model;
  Mesh mesh;
  mesh.points = Points(1, 3);
  mesh.points << 0, 0.5, 0;
  model.mesh = std::make_shared<const Mesh>(mesh);
  model.point_masses = {{0, 1}};
  Step step{.name = "press", .dt = 1, .count = 1, .gravity = Vec3::Zero()};
  step.prescribed = {fix({0}, true, false, true)};
  step.forces = {{.name = "down", .nodes = {0}, .values = {Vec3(0, -1, 0)}}};
  for (const double x : {-1.0, 1.0})
    step.springs.push_back(
        {.name = "bar", .first = 0, .point = Vec3(x, 0, 0), .stiffness = 100, .rest = std::hypot(1, 0.5)});
  model.steps = {step};
  model.settings.integrator = Integrator::static_;
  model.settings.load_steps = 2;
  model.settings.tolerance = 1e-10;
  model.settings.arc_length = {.on = true, .steps = 200, .displacement = 1.1};
  return model;
}

// Von Mises 1923: at height y both springs of length l = sqrt(1 + y^2) bear 2 k (l0 - l) y / l, at most where l^3 = l0.
TEST(ArcLength, SnapsATrussOfSpringsThrough) {
  double most = 0, least = 0;
  const Outcome outcome = follow(shallow_truss(), [&](const State& state) {
    const double y = 0.5 + state.displacement(0, 1), l = std::hypot(1, y);
    EXPECT_NEAR(state.load_factor, 200 * (std::hypot(1, 0.5) - l) * y / l, 1e-6);
    if (y > 0) most = std::max(most, state.load_factor);
    least = std::min(least, state.load_factor);
  });
  const double l0 = std::hypot(1, 0.5), l = std::cbrt(l0), peak = 200 * (l0 - l) * std::sqrt(l * l - 1) / l;
  EXPECT_NEAR(most, peak, 0.05 * peak);  // as far as the states lie apart
  EXPECT_NEAR(least, -peak, 0.05 * peak);
  EXPECT_GT(outcome.state.load_factor, 0);
  EXPECT_EQ(outcome.notes.size(), 2u);
}

/// A bar of stiffness E A / L = 1000 with a spring of 500 at its end to the point x = 3, pulled by 100.
Model bar_and_spring(double rest) {
  Model model = make_model(segment_mesh(4, 1, CellKind::line2),
                           {.youngs_modulus = 1000, .poisson_ratio = 0, .strain = Strain::small});
  const int end = nearest_point(*model.mesh, {1, 0, 0});
  Step& step = model.steps[0];
  step.prescribed = {fix({nearest_point(*model.mesh, {0, 0, 0})})};
  step.forces = {{.name = "pull", .nodes = {end}, .values = {Vec3(100, 0, 0)}}};
  step.springs = {{.name = "spring", .first = end, .point = Vec3(3, 0, 0), .stiffness = 500, .rest = rest}};
  model.settings.tolerance = 1e-10;
  model.settings.load_steps = 4;
  model.settings.arc_length = {.on = true, .steps = 50, .load = 2};
  return model;
}

// 1000 u = 100 f + 500 (2 - u - rest), whatever the spring is worth before the load.
TEST(ArcLength, StretchesABarAndASpringFromTheirEquilibrium) {
  for (const double rest : {2.0, 1.5, 2.75}) {
    const Model model = bar_and_spring(rest);
    const int end = nearest_point(*model.mesh, {1, 0, 0});
    follow(model, [&](const State& state) {
      EXPECT_NEAR(state.displacement(end, 0), (100 * state.load_factor + 500 * (2 - rest)) / 1500, 1e-8) << rest;
    });
  }
}

// A second step has another spring: what the first one held has gone when the loads start to change.
TEST(ArcLength, GoesOnWithTheSpringsOfEachStep) {
  Model model = bar_and_spring(1.5);
  model.steps.push_back(model.steps[0]);
  model.steps[1].springs[0].stiffness = 250;
  model.settings.arc_length.load = 1;
  const int end = nearest_point(*model.mesh, {1, 0, 0});
  follow(model, [&](const State& state) {
    if (state.step == 0) return;
    // The first step ends at the factor f1 >= 1 of its own load, which leaves as the second one's comes.
    EXPECT_GE(state.displacement(end, 0), (100 * 0.99 + 250 * 0.5) / 1250);
    EXPECT_LE(state.displacement(end, 0), (100 * 1.01 + 250 * 0.5) / 1250);
  });
}

/// The sphere of arc_length_test.cpp, incompressible.
double pressure(double la) {
  const auto f = [](double l) { return 2 / l + 0.5 / (l * l * l * l); };
  return f(std::cbrt(1 + (la * la * la - 1) / (1.5 * 1.5 * 1.5))) - f(la);
}

TEST(ArcLength, InflatesAnIncompressibleSphereWhosePressureIsUnknown) {
  Model model = make_model(sphere_octant(1, 1, 1.5, CellKind::tet10), {});
  model.regions[0].law = law_by_name("mooneyRivlinMaterial", {{"c1", 0.5}, {"incompressible", true}});
  model.formulation = Formulation::mixed;
  const Mesh& mesh = *model.mesh;
  for (int c = 0; c < 3; ++c)
    model.steps[0].prescribed.push_back(
        fix(points_where(mesh, [&](const Vec3& x) { return std::abs(x[c]) < 1e-6; }), c == 0, c == 1, c == 2));
  FaceLoad inside{.name = "inside", .pressures = {0.4}, .follower = true};
  inside.faces = faces_where(mesh, [](const Vec3& x) { return std::abs(x.norm() - 1) < 1e-6; });
  model.steps[0].face_loads = {inside};
  model.settings.load_steps = 2;
  model.settings.arc_length = {.on = true, .steps = 40, .displacement = 1};
  const int inner = nearest_point(mesh, {1, 0, 0});
  double largest = 0;
  const Outcome outcome = follow(model, [&](const State& state) {
    const double la = 1 + state.displacement(inner, 0), p = 0.4 * state.load_factor;
    largest = std::max(largest, p);
    EXPECT_NEAR(p, pressure(la), 0.05 * pressure(la)) << la;  // one curved element through the wall
  });
  EXPECT_LT(0.4 * outcome.state.load_factor, 0.99 * largest);
  EXPECT_GE(outcome.state.displacement.rowwise().norm().maxCoeff(), 1);
}

TEST(ArcLength, CarriesAnEmbeddedMeshAlong) {
  const auto law = [](double E) {
    return LinearElastic{.youngs_modulus = E, .poisson_ratio = 0, .strain = Strain::small};
  };
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), law(700));
  const auto at = [&](double x) { return [x](const Vec3& X) { return std::abs(X[0] - x) < 1e-9; }; };
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at(0)))};
  FaceLoad pull{.name = "pull", .tractions = {Vec3(100, 0, 0)}};
  pull.faces = faces_where(*model.mesh, at(1));
  model.steps[0].face_loads = {pull};
  model.settings.arc_length = {.on = true, .steps = 50, .load = 2};
  model.settings.load_steps = 4;
  Inlay inlay{
      .mesh = model.mesh, .region = {.name = "twin", .law = make_linear_elastic(law(300)), .elements = {}}, .ties = {}};
  inlay.region.elements = model.regions[0].elements;
  inlay.ties.resize(static_cast<std::size_t>(model.mesh->point_count()));
  for (const int e : inlay.region.elements)
    for (std::size_t a = 0; a < 4; ++a) {
      Tie tie{e, std::vector<double>(4, 0)};
      tie.weights[a] = 1;
      inlay.ties[static_cast<std::size_t>(model.mesh->cell(e)[a])] = tie;
    }
  model.inlays = {inlay};
  const int end = nearest_point(*model.mesh, {1, 1, 1});
  follow(model, [&](const State& state) { EXPECT_NEAR(state.displacement(end, 0), 0.1 * state.load_factor, 1e-9); });
}

// Neo-Hookean, W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2, pulled along x alone: with the stretches l and k,
// P = mu (l - 1/l) + lambda ln(l k^2)/l, and 0 = mu (k - 1/k) + lambda ln(l k^2)/k.
TEST(ArcLength, StretchesAPlateInPlaneStress) {
  const double E = 1000, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  Model model = make_model(rectangle_mesh(2, 2, 1, 1, CellKind::tri6), {});
  model.regions[0].law = neo_hookean("log", E, nu);
  model.plane = Plane::stress;
  const auto at = [](int axis, double x) { return [=](const Vec3& X) { return std::abs(X[axis] - x) < 1e-9; }; };
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at(0, 0)), true, false, false),
                               fix(points_where(*model.mesh, at(1, 0)), false, true, false)};
  FaceLoad pull{.name = "pull", .tractions = {Vec3(100, 0, 0)}};
  pull.faces = faces_where(*model.mesh, at(0, 1));
  model.steps[0].face_loads = {pull};
  model.settings.load_steps = 2;
  model.settings.tolerance = 1e-10;
  model.settings.arc_length = {.on = true, .steps = 50, .load = 4};
  const int corner = nearest_point(*model.mesh, {1, 1, 0});
  follow(model, [&](const State& state) {
    const double l = 1 + state.displacement(corner, 0), k = 1 + state.displacement(corner, 1), s = std::log(l * k * k);
    EXPECT_NEAR(100 * state.load_factor, mu * (l - 1 / l) + lambda * s / l, 1e-6);
    EXPECT_NEAR(mu * (k - 1 / k) + lambda * s / k, 0, 1e-6);
  });
}

}  // namespace
}  // namespace msml::fe
