// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/operators/shared/run_operator.hpp"

namespace msml {
namespace {

using Reals = std::vector<double>;

ImagePtr image(std::vector<std::uint8_t> values, const Vec3& origin = Vec3::Zero()) {
  Image made = make_image<std::uint8_t>({static_cast<int>(values.size()), 1, 1}, origin);
  made.voxels = std::move(values);
  return std::make_shared<const Image>(std::move(made));
}

TEST(ImageSum, AddsBytesWithoutOverflow) {
  const ImageList list{image({255, 1, 0}), image({255, 2, 0}), image({255, 4, 7})};
  const auto sum = test::output<Image>(test::run("ImageSum", {{"image", list}}));
  EXPECT_THAT(std::get<Reals>(sum->voxels), testing::ElementsAre(765, 7, 7));
}

TEST(ImageSum, NormalizeGivesTheMean) {
  const ImageList list{image({255, 1}), image({0, 2})};
  const auto mean = test::output<Image>(test::run("ImageSum", {{"image", list}, {"normalize", true}}));
  EXPECT_THAT(std::get<Reals>(mean->voxels), testing::ElementsAre(127.5, 1.5));
}

TEST(ImageSum, OfOneImageIsThatImage) {
  const auto sum = test::output<Image>(test::run("ImageSum", {{"image", Value(image({3, 4}, Vec3(1, 2, 3)))}}));
  EXPECT_THAT(std::get<Reals>(sum->voxels), testing::ElementsAre(3, 4));
  EXPECT_EQ(sum->origin, Vec3(1, 2, 3));
}

TEST(ImageSum, RefusesImagesOnDifferentGrids) {
  EXPECT_EQ(test::error_of("ImageSum", {{"image", ImageList{image({1, 2}), image({1, 2}, Vec3(0.5, 0, 0))}}}),
            "image 2 does not lie on the grid of the first image: origin (0.5 0 0), not (0 0 0)");
  EXPECT_EQ(test::error_of("ImageSum", {{"image", ImageList{image({1, 2}), image({1, 2, 3})}}}),
            "image 2 does not lie on the grid of the first image: size (3 1 1), not (2 1 1)");
  EXPECT_EQ(test::error_of("ImageSum", {{"image", ImageList{}}}), "there is no image to add");
}

}  // namespace
}  // namespace msml
