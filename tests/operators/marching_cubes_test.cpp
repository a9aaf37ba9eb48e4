// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

/// 2 - distance from the point (1 1 1) at every voxel: the level 1 is the unit sphere about it.
Image ball() {
  Image image = make_image<double>({41, 41, 41}, Vec3(-1, -1, -1), Vec3::Constant(0.1));
  auto& values = std::get<std::vector<double>>(image.voxels);
  for (int k = 0; k < 41; ++k)
    for (int j = 0; j < 41; ++j)
      for (int i = 0; i < 41; ++i)
        values[image.index(i, j, k)] = 2 - (image.origin + 0.1 * Vec3(i, j, k) - Vec3::Ones()).norm();
  return image;
}

SurfacePtr level(const Image& image, double iso, test::QuietReporter* listener = nullptr) {
  return test::output<Surface>(
      test::run("vtkMarchingCube", {{"image", std::make_shared<const Image>(image)}, {"isoValue", iso}}, listener));
}

TEST(MarchingCubes, FindsTheSphereAndFacesOutwards) {
  test::QuietReporter listener;
  const SurfacePtr s = level(ball(), 1, &listener);
  for (int i = 0; i < s->point_count(); ++i)
    EXPECT_NEAR((s->points.row(i).transpose() - Vec3::Ones()).norm(), 1,
                2e-3);  // linear on an edge: h^2 / (8 r) = 1.25e-3
  const double ball_volume = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_LT(test::volume(*s), ball_volume);
  // Corners lie up to h^2 / 8 inside, triangles in a cell sag by up to h^2 / 2 more: 4 pi times 6.25e-3.
  EXPECT_NEAR(test::volume(*s), ball_volume, 0.0785);
  EXPECT_EQ(s->triangle_count(), 2 * s->point_count() - 4);  // Euler, for one closed sphere
  EXPECT_TRUE(listener.warnings.empty());
}

TEST(MarchingCubes, FollowsATurnedImage) {
  Image image = ball();
  const Mat3 turn = Eigen::AngleAxisd(0.6, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  const Vec3 centre = image.origin + turn * (Vec3::Ones() - image.origin);
  image.direction = turn;
  const SurfacePtr s = level(image, 1);
  for (int i = 0; i < s->point_count(); ++i) EXPECT_NEAR((s->points.row(i).transpose() - centre).norm(), 1, 2e-3);
  EXPECT_GT(test::volume(*s), 0);
}

TEST(MarchingCubes, WarnsWhereTheObjectTouchesTheBorder) {
  test::QuietReporter listener;
  level(ball(), -0.2, &listener);  // a sphere of radius 2.2 in a cube of half side 2
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_THAT(listener.warnings[0], testing::HasSubstr("touches the border"));
}

TEST(MarchingCubes, RefusesALevelThatTheImageDoesNotReach) {
  Image image = make_image<std::uint8_t>({2, 2, 2});
  std::get<std::vector<std::uint8_t>>(image.voxels)[0] = 255;
  EXPECT_EQ(test::error_of("vtkMarchingCube", {{"image", std::make_shared<const Image>(image)}, {"isoValue", 300.0}}),
            "isoValue = 300 is not above 0 and at most 255, the values of the image");
}

}  // namespace
}  // namespace msml
