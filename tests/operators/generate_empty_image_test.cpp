// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/operators/shared/run_operator.hpp"

namespace msml {
namespace {

using Reals = std::vector<double>;
using Wholes = std::vector<Integer>;

TEST(GenerateEmptyImage3D, MakesZerosOnTheGridAskedFor) {
  const auto image = test::output<Image>(test::run(
      "GenerateEmptyImage3D", {{"dim", Wholes{4, 3, 2}}, {"spacing", Reals{0.5, 1, 2}}, {"origin", Reals{-40, 0, 7}}}));
  EXPECT_EQ(image->size, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(image->spacing, Vec3(0.5, 1, 2));
  EXPECT_EQ(image->origin, Vec3(-40, 0, 7));
  EXPECT_EQ(std::get<Reals>(image->voxels), Reals(24, 0.0));
}

TEST(GenerateEmptyImage3D, HasUnitSpacingAtTheOriginUnlessTold) {
  const auto image = test::output<Image>(test::run("GenerateEmptyImage3D", {{"dim", Wholes{1, 1, 1}}}));
  EXPECT_EQ(image->spacing, Vec3(1, 1, 1));
  EXPECT_EQ(image->origin, Vec3(0, 0, 0));
}

TEST(GenerateEmptyImage3D, RefusesSizesThatCannotBe) {
  EXPECT_EQ(test::error_of("GenerateEmptyImage3D", {{"dim", Wholes{65536, 65536, 65536}}}),
            "an image of 65536 x 65536 x 65536 voxels of 1 components is not possible");
}

}  // namespace
}  // namespace msml
