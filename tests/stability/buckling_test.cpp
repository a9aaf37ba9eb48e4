// SPDX-License-Identifier: GPL-3.0-or-later
// A column under a dead load: where it buckles, and what the program calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stability/bars.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr double length = 10;

/// A column [0,10] x [0,1] x [0,1], E = 1000, nu = 0, held at x = 0.
Model column() {
  Model model = make_model(box_mesh(10, 1, 1, {length, 1, 1}, CellKind::tet10),
                           {.youngs_modulus = 1000, .poisson_ratio = 0, .strain = Strain::corotated});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  return model;
}

Outcome pressed(double stress) {
  Model model = column();
  FaceLoad load{.name = "press", .tractions = {Vec3(-stress, 0, 0)}};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > length - 1e-9; });
  model.steps[0].face_loads = {load};
  return solve(model, {});
}

/// Euler's load of a clamped column over its section of 1: pi^2 E I/(4 L^2), I = 1/12.
const double euler = M_PI * M_PI * 1000 / 12 / (4 * length * length);

// Shear and the thickness lower it by about 1 %, ten elements along the column raise it by less than 5 %.
TEST(Column, BucklesAtEulersLoadUnderADeadForce) {
  EXPECT_EQ(pressed(0.95 * euler).stop, Stop::converged);
  const Outcome over = pressed(1.1 * euler);
  EXPECT_EQ(over.stop, Stop::indefinite_tangent) << over.diagnosis;
  EXPECT_THAT(over.diagnosis, HasSubstr("the equilibrium is unstable"));
}

}  // namespace
}  // namespace msml::fe
