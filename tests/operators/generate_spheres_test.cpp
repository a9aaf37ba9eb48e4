// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

using test::run;

TEST(GenerateSpheres, PointAndTriangleCountsFollowFromTheResolutions) {
  const auto s = test::output<Surface>(run("GenerateSpheres", {{"centers", std::vector<double>{0, 0, 0, 100, 0, 0}},
                                                               {"thetaResolution", Integer{6}},
                                                               {"phiResolution", Integer{5}}}));
  EXPECT_EQ(s->point_count(), 2 * (6 * (5 - 2) + 2));
  EXPECT_EQ(s->triangle_count(), 2 * (2 * 6 * (5 - 2)));  // Euler: F = 2 V - 4 for each closed sphere
}

TEST(GenerateSpheres, PointsLieOnTheSphereAtFullPrecision) {
  const auto s =
      test::output<Surface>(run("GenerateSpheres", {{"centers", std::vector<double>{1, 2, 3}}, {"radius", 2.5}}));
  for (int i = 0; i < s->point_count(); ++i)
    EXPECT_NEAR((s->points.row(i) - Eigen::RowVector3d(1, 2, 3)).norm(), 2.5, 1e-14);  // round-off of doubles
}

TEST(GenerateSpheres, FineSpheresFaceOutwardsAndFillTheBall) {
  const auto s = test::output<Surface>(run("GenerateSpheres", {{"centers", std::vector<double>{0, 0, 0}},
                                                               {"radius", 3.0},
                                                               {"thetaResolution", Integer{100}},
                                                               {"phiResolution", Integer{100}}}));
  const double ball = 4.0 / 3.0 * std::numbers::pi * 27;
  const double volume = test::volume(*s);
  EXPECT_LT(volume, ball);                 // inscribed
  EXPECT_NEAR(volume, ball, 2e-3 * ball);  // chord error (pi/100)^2 in each of two directions
}

TEST(GenerateSpheres, NoCentreIsAnError) {
  EXPECT_EQ(test::error_of("GenerateSpheres", {{"centers", std::vector<double>{}}}),
            "centers is empty; three numbers per sphere are needed");
}

}  // namespace
}  // namespace msml
