// SPDX-License-Identifier: GPL-3.0-or-later
// Statics of bodies that nothing holds, or not in all directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msml/core/error.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

/// A bar of length 2 along x, pulled at both ends by a stress of 5.
Model pulled_bar(Strain strain, double young) {
  Model model = make_model(box_mesh(4, 2, 2, {2, 1, 1}, CellKind::tet10),
                           {.youngs_modulus = young, .poisson_ratio = 0.3, .strain = strain});
  for (const double x : {0.0, 2.0}) {
    FaceLoad pull{.name = "pull", .tractions = {Vec3(x > 1 ? 5 : -5, 0, 0)}};
    pull.faces = faces_where(*model.mesh, [=](const Vec3& X) { return std::abs(X[0] - x) < 1e-9; });
    model.steps[0].face_loads.push_back(pull);
  }
  return model;
}

TEST(FreeBody, UnderBalancedLoadsIsSolvedUpToARigidMotion) {
  for (const Strain strain : {Strain::small, Strain::corotated}) {
    const Model model = pulled_bar(strain, 1000);
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    ASSERT_EQ(outcome.notes.size(), 1u);
    EXPECT_THAT(outcome.notes[0], HasSubstr("6 rigid motions are free"));
    // strain 5/1000 along x, -0.3 times that across; the mean stays where it was.
    for (int n = 0; n < model.mesh->point_count(); ++n) {
      const Vec3 X = model.mesh->points.row(n).transpose() - Vec3(1, 0.5, 0.5);
      const Vec3 exact = 0.005 * Vec3(X[0], -0.3 * X[1], -0.3 * X[2]);
      EXPECT_LT((outcome.state.displacement.row(n).transpose() - exact).norm(), 1e-7 * 0.005) << n;
    }
    EXPECT_LT(outcome.check.residual, 1e-7);
  }
}

TEST(FreeBody, UnderLoadsThatPushItAwayIsRefused) {
  Model model = pulled_bar(Strain::small, 1000);
  model.steps[0].face_loads.pop_back();
  EXPECT_THROW(solve(model, {}), Error);
  model = pulled_bar(Strain::small, 1000);
  model.steps[0].gravity = Vec3(0, 0, -1);
  EXPECT_THROW(solve(model, {}), Error);
}

TEST(FreeBody, HeldInOneDirectionIsSolvedUpToTheOthers) {
  Model model = pulled_bar(Strain::small, 1000);
  model.steps[0].prescribed = {
      fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; }), false, false, true)};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_THAT(outcome.notes.at(0), HasSubstr("3 rigid motions are free"));
  const int corner = nearest_point(*model.mesh, {2, 1, 1});
  EXPECT_NEAR(outcome.state.displacement(corner, 0), 0.005, 1e-9);
  EXPECT_NEAR(outcome.state.displacement(corner, 2), -0.0015, 1e-9);
}

}  // namespace
}  // namespace msml::fe
