// SPDX-License-Identifier: GPL-3.0-or-later
// Loads: totals, follower pressure and its tangent.
#include <gtest/gtest.h>

#include <numeric>

#include "msml/core/error.hpp"
#include "solver/equations.hpp"
#include "tests/solver/element_points.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

Vec3 total(const Vector& v) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < v.size(); k += 3) sum += v.segment<3>(k);
  return sum;
}

Model loaded_box(CellKind kind, FaceLoad load, const std::function<bool(const Vec3&)>& where) {
  Model model = make_model(box_mesh(2, 2, 2, {2, 1, 3}, kind), {}, 5);
  load.name = "load";
  load.faces = faces_where(*model.mesh, where);
  model.steps[0].face_loads = {load};
  return model;
}

bool on_top(const Vec3& x) { return x[2] > 3 - 1e-9; }

TEST(Loads, PressureOnAFlatFacePushesAgainstItsNormal) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Equations equations(loaded_box(kind, {.pressures = {7}}, on_top));
    EXPECT_LT((total(equations.loads(0).dead) - Vec3(0, 0, -7 * 2 * 1)).norm(), 1e-12);
  }
}

TEST(Loads, TractionCountsPerReferenceArea) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Equations equations(loaded_box(kind, {.tractions = {Vec3(1, -2, 3)}}, on_top));
    EXPECT_LT((total(equations.loads(0).dead) - 2 * Vec3(1, -2, 3)).norm(), 1e-12);
  }
}

TEST(Loads, GravityIsTheWeight) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = make_model(box_mesh(2, 2, 2, {2, 1, 3}, kind), {}, 5);
    model.steps[0].gravity = Vec3(1, 0, -9.81);
    EXPECT_LT((total(Equations(model).loads(0).dead) - 30 * Vec3(1, 0, -9.81)).norm(), 1e-10);
  }
}

TEST(Loads, ForceOnANodeOutsideTheBodyIsRefused) {
  Mesh mesh = box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4);
  mesh.points.conservativeResize(9, 3);
  mesh.points.row(8).setConstant(4);
  Model model = make_model(std::move(mesh), {});
  model.steps[0].forces = {{.name = "pull", .nodes = {8}, .values = {Vec3(0, 0, 1)}}};
  try {
    const Equations equations(model);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "force 'pull' acts on node 8, which belongs to no element");
  }
}

// Over a closed surface: no resultant and no moment in any deformed state, and f . v = -p dV/dt.
TEST(FollowerPressure, OnAClosedSurfaceHasNoResultantAndWorksOnTheVolume) {
  Random random;
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Model model = loaded_box(kind, {.pressures = {3}, .follower = true}, [](const Vec3&) { return true; });
    const Equations equations(model);
    Vector u(equations.size()), v(equations.size()), force = Vector::Zero(equations.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = 0.1 * random.number(), v[k] = random.number();
    add_followers({&equations.loads(0), 1, 0}, equations.positions(), u, force, nullptr);
    EXPECT_LT(total(force).norm(), 1e-12);
    const auto volume = [&](const Vector& w) {
      // The divergence theorem over tetrahedra that share all nodes: exact for tet4 by its constant J.
      double sum = 0;
      for (const ElementPoints& e : points_of(equations.elements(), w))
        for (int q = 0; q < e.count; ++q) {
          Mat3 F = Mat3::Identity();
          for (int k = 0; k < 9; ++k) F(k / 3, k % 3) += e.gradient.c[k][q];
          sum += e.weight[q] * F.determinant();
        }
      return sum;
    };
    if (kind == CellKind::tet4) {
      const double h = 1e-5;
      EXPECT_NEAR(force.dot(v), -3 * (volume(u + h * v) - volume(u - h * v)) / (2 * h), 1e-7);
    }
  }
}

TEST(FollowerPressure, TangentIsTheDerivative) {
  Random random;
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Model model =
        loaded_box(kind, {.pressures = {3}, .follower = true}, [](const Vec3& x) { return x[2] > 0.999; });
    const Equations equations(model);
    const auto force_at = [&](const Vector& w) {
      Vector f = Vector::Zero(equations.size());
      add_followers({&equations.loads(0), 0.5, 0}, equations.positions(), w, f, nullptr);
      return f;
    };
    Vector u(equations.size()), v(equations.size()), force = Vector::Zero(equations.size()), product;
    for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = 0.1 * random.number(), v[k] = random.number();
    BlockMatrix tangent(equations.elements().pattern());
    add_followers({&equations.loads(0), 0.5, 0}, equations.positions(), u, force, &tangent);
    multiply(tangent, v, product);
    const double h = 1e-5;  // forces are quadratic in u: central differences are exact but for round-off 1e-16 / h
    const Vector slope = (force_at(u + h * v) - force_at(u - h * v)) / (2 * h);
    EXPECT_LT((product + slope).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(FollowerPressure, InflatesABallAsTheDeadOneDoesWhenSmall) {
  for (const bool follower : {false, true}) {
    Model model = make_model(sphere_octant(4, 1, 2, CellKind::tet10), {.youngs_modulus = 1e6});
    Step& step = model.steps[0];
    for (int d = 0; d < 3; ++d)
      step.prescribed.push_back(
          fix(points_where(*model.mesh, [&](const Vec3& x) { return std::abs(x[d]) < 1e-9; }), d == 0, d == 1, d == 2));
    step.face_loads = {{.name = "inside", .pressures = {1}, .follower = follower}};
    step.face_loads[0].faces = faces_where(*model.mesh, [](const Vec3& x) { return std::abs(x.norm() - 1) < 1e-9; });
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    // Lame's 8e-7; the mesh is within 1 %.
    EXPECT_NEAR(outcome.state.displacement(nearest_point(*model.mesh, {1, 0, 0}), 0), 8e-7, 8e-9);
  }
}

// A slender bar pulled by a follower tension: the unsymmetric part of the tangent is far larger than the bending
// stiffness, and without it Newton's method fails. A pull P that turns with its face holds the bar's direction by no
// more than exp(-L sqrt(P/EI)) of that, 2e-5 here: were it three times larger, 1e-8, the mesh's own asymmetry would
// bend it.
TEST(FollowerPressure, StretchesASlenderBar) {
  Model model = make_model(box_mesh(10, 1, 1, {10, 1, 1}, CellKind::tet10), {.youngs_modulus = 1000});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  FaceLoad load{.name = "end", .pressures = {-100}, .follower = true};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 10 - 1e-9; });
  model.steps[0].face_loads = {load};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_LT(outcome.check.residual, 1e-8);
  // Uniaxial, nu = 0.3: e = p/E (1 - 0.3 e)^2 gives e = 0.09442; the held end and the ends' triangles change it by less
  // than 2 %.
  EXPECT_NEAR(outcome.state.displacement(nearest_point(*model.mesh, {10, 0.5, 0.5}), 0), 0.9442, 0.02);
}

TEST(FollowerPressure, ConvergesWhereTheLoadedFaceHasAFreeRim) {
  Model model = make_model(box_mesh(10, 1, 1, {10, 1, 1}, CellKind::tet10), {.youngs_modulus = 1000});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  FaceLoad load{.name = "top", .pressures = {0.4}, .follower = true};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[2] > 1 - 1e-9; });
  model.steps[0].face_loads = {load};
  model.settings.load_steps = 4;
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_LT(outcome.check.residual, 1e-8);
  EXPECT_GT(outcome.check.largest_rotation, 30);  // far into the finite range
}

// A pressure on the free end follows it: such a load has no energy, the symmetric part of its tangent is indefinite
// long before anything buckles, and the beam bends to 60 degrees and more along a stable path.
TEST(FollowerPressure, OnAnOpenEndIsNotTakenForBuckling) {
  Model model = make_model(box_mesh(8, 2, 2, {4, 1, 1}, CellKind::tet10), {});
  model.regions[0].law = neo_hookean("log", 1000, 0.3);
  const Mesh& mesh = *model.mesh;
  model.steps[0].prescribed = {fix(points_where(mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  FaceLoad load{.name = "p", .pressures = {11}, .follower = true};
  load.faces = faces_where(mesh, [](const Vec3& x) { return x[2] > 1 - 1e-9; });
  model.steps[0].face_loads = {load};
  Vec3 tips[2];
  for (const LinearSolver solver : {LinearSolver::direct, LinearSolver::cg}) {
    model.settings.linear_solver = solver;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_LT(outcome.check.residual, 1e-7);
    tips[solver == LinearSolver::cg] = outcome.state.displacement.row(nearest_point(mesh, {4, 0.5, 0.5})).transpose();
  }
  EXPECT_LT((tips[0] - tips[1]).norm(), 1e-6);
  EXPECT_GT(tips[0].norm(), 3);
}

}  // namespace
}  // namespace msml::fe
