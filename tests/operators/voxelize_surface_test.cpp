// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SurfacePtr box(const Vec3& low, const Vec3& high) { return std::make_shared<const Surface>(test::box(low, high)); }

ImagePtr voxelize(const test::Arguments& arguments, test::QuietReporter* listener = nullptr) {
  return test::output<Image>(test::run("VoxelizeSurfaceMesh", arguments, listener));
}

double filled_volume(const Image& image) {
  const auto& v = std::get<std::vector<std::uint8_t>>(image.voxels);
  EXPECT_TRUE(std::all_of(v.begin(), v.end(), [](int x) { return x == 0 || x == 255; }));
  return static_cast<double>(std::count(v.begin(), v.end(), 255)) * image.spacing.prod();
}

TEST(VoxelizeSurfaceMesh, FillsABoxExactlyWhenVoxelsFitIt) {
  const ImagePtr image = voxelize({{"surfaceMesh", box(Vec3(1, 2, 3), Vec3(3, 3, 7))}, {"resolution", Integer{8}}});
  EXPECT_THAT(image->size, ElementsAre(4 + 2, 2 + 2, 8 + 2));  // edge 0.5, and one empty layer around
  EXPECT_DOUBLE_EQ(filled_volume(*image), 2 * 1 * 4);
  EXPECT_EQ(image->origin, Vec3(0.75, 1.75, 2.75));  // half a voxel outside of the corner
}

TEST(VoxelizeSurfaceMesh, ApproachesTheVolumeOfABall) {
  const Value ball = test::run("GenerateSpheres", {{"centers", std::vector<double>{0.3, 0.2, 0.1}},
                                                   {"radius", 1.0},
                                                   {"thetaResolution", Integer{100}},
                                                   {"phiResolution", Integer{100}}});
  const double exact = 4.0 / 3.0 * std::numbers::pi;
  const ImagePtr image = voxelize({{"surfaceMesh", ball}, {"isotropicVoxelSize", 0.05}});
  // Voxels cut by the sphere err by half a voxel at random: 4 pi / h^2 of them give 0.5 h^3 sqrt(4 pi) / h, far below
  // the 0.2 % by which the triangles lie inside the sphere.
  EXPECT_NEAR(filled_volume(*image), exact, 0.006 * exact);
}

TEST(VoxelizeSurfaceMesh, AddsTheMarginOnAllSides) {
  const ImagePtr image = voxelize({{"surfaceMesh", box(Vec3::Zero(), Vec3::Ones())},
                                   {"isotropicVoxelSize", 0.25},
                                   {"additionalIsotropicMargin", 0.5}});
  EXPECT_THAT(image->size, ElementsAre(8 + 2, 8 + 2, 8 + 2));
  EXPECT_DOUBLE_EQ(filled_volume(*image), 1);
}

TEST(VoxelizeSurfaceMesh, TakesTheReferenceGridEvenIfItIsTurned) {
  Image grid = make_image<std::uint8_t>({20, 20, 20}, Vec3(0, 0, 0), Vec3::Constant(0.1));
  grid.direction = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()).toRotationMatrix();  // x -> y, y -> -x
  const Value reference = std::make_shared<const Image>(grid);
  const ImagePtr image = voxelize(
      {{"surfaceMesh", box(Vec3(-1.05, 0.05, 0.05), Vec3(-0.55, 0.35, 0.15))}, {"referenceCoordinateGrid", reference}});
  EXPECT_EQ(image->direction, grid.direction);
  EXPECT_NEAR(filled_volume(*image), 0.5 * 0.3 * 0.1, 1e-12);
  EXPECT_EQ(image->at(image->index(1, 6, 1)), 255);  // at (-0.6 0.1 0.1)
  EXPECT_EQ(image->at(image->index(6, 1, 1)), 0);
}

TEST(VoxelizeSurfaceMesh, FillsHolesWithAWarning) {
  Surface open = test::box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  test::QuietReporter listener;
  const ImagePtr image =
      voxelize({{"surfaceMesh", std::make_shared<const Surface>(open)}, {"resolution", Integer{4}}}, &listener);
  EXPECT_DOUBLE_EQ(filled_volume(*image), 1);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_THAT(listener.warnings[0], HasSubstr("3 edges belong to one triangle only and 0 to more than two"));
  EXPECT_THAT(listener.warnings[0], HasSubstr("its holes are filled with 1 triangles"));
}

TEST(VoxelizeSurfaceMesh, RefusesAnOpenSurfaceWhereHolesMayNotBeFilled) {
  Surface open = test::box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  EXPECT_EQ(
      test::error_of("VoxelizeSurfaceMesh", {{"surfaceMesh", std::make_shared<const Surface>(open)},
                                             {"resolution", Integer{4}},
                                             {"disableFillHoles", true}}),
      "the surface is not closed: 3 edges belong to one triangle only and 0 to more than two (the first at 1 0 0.5)");
}

TEST(VoxelizeSurfaceMesh, WantsExactlyOneOfThreeWaysToSayTheGrid) {
  const Value surface = box(Vec3::Zero(), Vec3::Ones());
  EXPECT_THAT(test::error_of("VoxelizeSurfaceMesh", {{"surfaceMesh", surface}}),
              testing::StartsWith("0 of resolution"));
  EXPECT_THAT(test::error_of("VoxelizeSurfaceMesh",
                             {{"surfaceMesh", surface}, {"resolution", Integer{4}}, {"isotropicVoxelSize", 1.0}}),
              testing::StartsWith("2 of resolution"));
}

TEST(VoxelizeSurfaceMesh, RefusesImagesBeyondReason) {
  EXPECT_THAT(test::error_of("VoxelizeSurfaceMesh",
                             {{"surfaceMesh", box(Vec3::Zero(), Vec3::Ones())}, {"isotropicVoxelSize", 1e-5}}),
              HasSubstr("the limit is 2^31 voxels"));
}

}  // namespace
}  // namespace msml
