// SPDX-License-Identifier: GPL-3.0-or-later
// Statics of bodies that nothing holds, or not in all directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

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

// What is left of both is round-off, which pushes nowhere; how large it is, depends on the BLAS. Against rigid motions
// stands a shift of 1e-8 of the stiffness alone.
TEST(FreeBody, IsSolvedWhereABodyForceTakesItsWeight) {
  Model model = make_model(box_mesh(2, 2, 2, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1000}, 3);
  model.steps[0].gravity = Vec3(0, 0, -10.1);
  BodyForce force{.name = "buoyancy", .value = Vec3(0, 0, 3 * 10.1)};
  for (int cell = 0; cell < model.mesh->cell_count(); ++cell) force.elements.push_back(cell);
  model.steps[0].body_forces = {force};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double round_off = std::numeric_limits<double>::epsilon() * 3 * 10.1;
  EXPECT_LT(outcome.state.displacement.norm(), round_off / (1e-8 * 1000));
}

TEST(FreeBody, UnderLoadsThatPushItAwayIsRefused) {
  Model model = pulled_bar(Strain::small, 1000);
  model.steps[0].face_loads.pop_back();
  EXPECT_THROW(solve(model, {}), Error);
  model = pulled_bar(Strain::small, 1000);
  model.steps[0].gravity = Vec3(0, 0, -1);
  EXPECT_THROW(solve(model, {}), Error);
}

/// What is said when a bar [0,2] x [0,1] x [0,1] that is held so is loaded so.
std::string refused(std::vector<Prescribed> held, std::vector<NodalForce> forces) {
  Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet4), {});
  model.steps[0].prescribed = std::move(held);
  model.steps[0].forces = std::move(forces);
  try {
    solve(model, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "solved";
}

int corner(const Vec3& place) {
  return points_where(box_mesh(2, 1, 1, {2, 1, 1}, CellKind::tet4),
                      [&](const Vec3& X) { return (X - place).norm() < 1e-9; })
      .front();
}

// Forces and moments by hand; the mean of the twelve nodes is (1 0.5 0.5).
TEST(FreeBody, LoadsThatDoNotBalanceAreNamedWithTheMotionAndTheirSize) {
  const auto force = [](const Vec3& place, const Vec3& F) {
    return NodalForce{.name = "push", .nodes = {corner(place)}, .values = {F}};
  };
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(2, 1, 1);
  const std::string both = refused({}, {force(b, Vec3(0, 3, 0))});
  EXPECT_THAT(both, HasSubstr("6 of the 6 rigid motions of the part of 12 nodes around (1 0.5 0.5) are free"));
  // The arm (1, -0.5, -0.5) x (0, 3, 0) = (1.5, 0, 3).
  EXPECT_THAT(both, HasSubstr("its loads do not balance: they push it along y with a force of 3, and round "
                              "(0.447 0 0.894) through its centre with a moment of 3.354"));
  EXPECT_THAT(refused({}, {force(b, Vec3(0, 3, 0)), force(a, Vec3(0, -3, 0))}),
              HasSubstr("they push it round z through its centre with a moment of 6. Balance them"));
  EXPECT_THAT(refused({}, {force(a, Vec3(-1, -1, -1)), force(c, Vec3(-1, -1, -1))}),
              HasSubstr("along (-0.577 -0.577 -0.577) with a force of 3.464. "));
  EXPECT_THAT(refused({fix({corner(a), corner(c)}, false, true, true), fix({corner(b)}, false, true, true)},
                      {force(a, Vec3(-7, 1, 1))}),
              HasSubstr("1 of the 6 rigid motions of the part of 12 nodes around (1 0.5 0.5) is free, and its loads do "
                        "not balance: they push it along -x with a force of 7. "));
  // A hinge along z through a: the force at b, 2 away.
  EXPECT_THAT(refused({fix({corner(a), corner(Vec3(0, 0, 1))})}, {force(b, Vec3(4, 5, 6))}),
              HasSubstr("round z through (0 0 0.5) with a moment of 10. "));
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
