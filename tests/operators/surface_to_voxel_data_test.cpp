// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

Value cube() { return std::make_shared<const Surface>(test::box(Vec3::Zero(), Vec3::Ones())); }

ImagePtr image_of(double level, double smoothing) {
  return test::output<Image>(test::run("SurfaceToVoxelDataOperator",
                                       {{"surfaceMesh", cube()}, {"accuracy_level", level}, {"smoothing", smoothing}}));
}

TEST(SurfaceToVoxelData, DividesTheLongestSideByTwoToTheLevel) {
  const ImagePtr image = image_of(4, 0);
  EXPECT_DOUBLE_EQ(image->spacing[0], 1.0 / 16);
  EXPECT_EQ(image->size, (std::array<int, 3>{18, 18, 18}));
}

TEST(SurfaceToVoxelData, WithoutSmoothingIsBinaryAndFillsTheCube) {
  const auto values = std::get<std::vector<float>>(image_of(3, 0)->voxels);
  EXPECT_EQ(std::count(values.begin(), values.end(), 255.0F), 8 * 8 * 8);
  EXPECT_EQ(std::count(values.begin(), values.end(), 0.0F) + 512, static_cast<long>(values.size()));
}

TEST(SurfaceToVoxelData, SmoothingKeepsTheSumAndTheMiddleAndHalvesTheFaces) {
  const ImagePtr image = image_of(5, 1.5);
  const auto values = std::get<std::vector<float>>(image->voxels);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  EXPECT_NEAR(sum, 255.0 * 32 * 32 * 32, 1e-4 * sum);  // the kernel's weights add up to 1; single precision
  const int n = image->size[0], middle = n / 2;
  EXPECT_NEAR(image->at(image->index(middle, middle, middle)), 255, 1e-3);
  int face = 0;
  while (image->at(image->index(face, middle, middle)) < 127.5) ++face;
  const double left = image->at(image->index(face - 1, middle, middle)),
               right = image->at(image->index(face, middle, middle));
  EXPECT_NEAR(left + right, 255, 1e-3);  // symmetric about the face between the two voxels
  EXPECT_NEAR(image->origin[0] + (face - 0.5) * image->spacing[0], 0, 1e-12);
  EXPECT_EQ(image->at(0), 0);
}

TEST(SurfaceToVoxelData, RefusesAnOpenSurface) {
  Surface open = test::box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  EXPECT_EQ(test::error_of("SurfaceToVoxelDataOperator", {{"surfaceMesh", std::make_shared<const Surface>(open)}}),
            "the surface is not closed: 3 edges belong to one triangle only (the first at 1 0 0.5)");
}

}  // namespace
}  // namespace msml
