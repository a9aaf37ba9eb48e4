// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that slide in oblique planes: a scene turned in space has the turned answer.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "msml/core/error.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

Mat3 turn() { return Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(); }

/// A box in three symmetry planes, its far end pulled, everything turned by R. The planes meet at edges and a corner.
Model quarter(const Mat3& R, Integrator integrator, double poisson = 0.3) {
  const Mesh straight = box_mesh(3, 2, 2, {3, 1, 2}, CellKind::tet4);
  Mesh mesh = straight;
  mesh.points = straight.points * R.transpose();
  Model model = make_model(std::move(mesh), {.poisson_ratio = poisson}, 2);
  model.settings.integrator = integrator;
  model.settings.tolerance = 1e-12;
  Step& step = model.steps[0];
  step.dt = 0.05;
  step.count = 5;
  for (int c = 0; c < 3; ++c) {
    const auto nodes = points_where(straight, [c](const Vec3& x) { return x[c] < 1e-9; });
    if (R.isIdentity())
      step.prescribed.push_back(fix(nodes, c == 0, c == 1, c == 2));
    else
      step.slides.push_back({.name = "plane", .nodes = nodes, .normal = -2 * R.col(c)});
  }
  step.face_loads = {{.name = "pull",
                      .faces = faces_where(straight, [](const Vec3& x) { return x[0] > 3 - 1e-9; }),
                      .tractions = {R * Vec3(20, 5, -3)}}};
  return model;
}

// Both solutions agree to the tolerance of Newton's method, 1e-12, times the condition of the problem, about 1e3.
TEST(Slides, ATurnedSceneHasTheTurnedAnswer) {
  for (const Integrator integrator : {Integrator::static_, Integrator::newmark, Integrator::central_difference}) {
    Model straight = quarter(Mat3::Identity(), integrator), turned = quarter(turn(), integrator);
    if (integrator == Integrator::central_difference) straight.steps[0].dt = turned.steps[0].dt = 1e-3;
    const Outcome one = solve(straight, {}), two = solve(turned, {});
    ASSERT_EQ(one.stop, Stop::converged) << one.diagnosis;
    ASSERT_EQ(two.stop, Stop::converged) << two.diagnosis;
    EXPECT_EQ(one.unknowns, two.unknowns);
    const auto same = [](const Points& a, const Points& b) {
      EXPECT_GT(a.norm(), 0);
      EXPECT_LT((a * turn().transpose() - b).norm(), 1e-8 * a.norm());
    };
    same(one.state.displacement, two.state.displacement);
    same(one.state.reaction, two.state.reaction);
    if (is_dynamic(integrator)) same(one.state.velocity, two.state.velocity);
    EXPECT_LT(two.check.balance, 1e-8);
  }
}

// What an iterative solver leaves across the planes must not add up over steps: round-off alone, below 1e-12 of the
// body.
TEST(Slides, NodesStayInTheirPlanesWithEverySolver) {
  for (const Preconditioner preconditioner :
       {Preconditioner::jacobi, Preconditioner::incomplete_cholesky, Preconditioner::multigrid}) {
    Model model = quarter(turn(), Integrator::newmark);
    model.settings.linear_solver = LinearSolver::cg;
    model.settings.preconditioner = preconditioner;
    model.settings.tolerance = 1e-6;
    model.steps[0].count = 40;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Points back = outcome.state.displacement * turn();
    const Mesh box = box_mesh(3, 2, 2, {3, 1, 2}, CellKind::tet4);
    for (int c = 0; c < 3; ++c)
      for (const int node : points_where(box, [c](const Vec3& x) { return x[c] < 1e-9; }))
        EXPECT_LT(std::abs(back(node, c)), 1e-12) << static_cast<int>(preconditioner) << ", node " << node;
    EXPECT_GT(back.norm(), 0.01);
  }
}

TEST(Slides, TwoPlanesLeaveALineAndThreeHold) {
  const Outcome outcome = solve(quarter(turn(), Integrator::static_), {});
  const Points back = outcome.state.displacement * turn();  // in the box's own axes
  const Mesh box = box_mesh(3, 2, 2, {3, 1, 2}, CellKind::tet4);
  EXPECT_LT(back.row(nearest_point(box, {0, 0, 0})).norm(), 1e-14);
  const Eigen::RowVector3d edge = back.row(nearest_point(box, {3, 0, 0}));
  EXPECT_LT(std::hypot(edge[1], edge[2]), 1e-13);
  EXPECT_GT(std::abs(edge[0]), 1e-3);
}

TEST(Slides, ThatLeaveARigidMotionFreeAreRefusedInStatics) {
  Model model = quarter(turn(), Integrator::static_);
  model.steps[0].slides.pop_back();
  EXPECT_THROW(solve(model, {}), Error);
}

TEST(Slides, ASupportThatMovesOutOfThePlaneIsRefused) {
  Model model = quarter(turn(), Integrator::static_);
  const int node = model.steps[0].slides[0].nodes.front();
  model.steps[0].prescribed = {{.name = "pull", .nodes = {node}, .values = {Vec3(1, 0, 0)}}};
  try {
    solve(model, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "node " + std::to_string(node) +
                                             " is in the plane of 'plane', but a support moves it out of it along x; "
                                             "take it out of the indices of one");
  }
}

TEST(Slides, SupportsMayMoveANodeAlongItsPlane) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {.poisson_ratio = 0.3});
  model.settings.integrator = Integrator::static_;
  const auto end = points_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
  Step& step = model.steps[0];
  step.prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; })),
                     {.name = "move", .nodes = end, .values = {Vec3(0.1, -0.1, 0)}, .components = {true, true, false}}};
  step.slides = {{.name = "plane", .nodes = end, .normal = Vec3(1, 1, 0)}};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  for (const int node : end) {
    EXPECT_DOUBLE_EQ(outcome.state.displacement(node, 0), 0.1);
    EXPECT_DOUBLE_EQ(outcome.state.displacement(node, 1), -0.1);
  }
}

}  // namespace
}  // namespace msml::fe
