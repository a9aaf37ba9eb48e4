// SPDX-License-Identifier: GPL-3.0-or-later
// The signed polar decomposition on rotations, stretches, mirror images and flat gradients.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "solver/materials/polar.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using testing::Random;

Mat3 polar_in_lane(const Mat3& F, int lane) {
  Tensor<Lanes> batch{};
  for (int i = 0; i < 3; ++i) batch(i, i) += 2.0;
  for (int k = 0; k < 9; ++k) batch.c[k][lane] = F(k / 3, k % 3);
  const Tensor<Lanes> R = polar_rotation(batch);
  Mat3 r;
  for (int k = 0; k < 9; ++k) r(k / 3, k % 3) = R.c[k][lane];
  return r;
}

// F = Q V diag(s) V^T has the nearest rotation Q as long as the two smallest stretches add up to more than 0.
TEST(Polar, FindsTheRotationItWasMadeFrom) {
  Random random;
  const std::array<std::array<double, 3>, 7> stretches{
      {{1, 1, 1}, {1.001, 1, 0.999}, {5, 2, 0.1}, {1e3, 1, 1e-3}, {1, 1, 0}, {2, 1, -0.5}, {1, 1e-3, 0}}};
  for (const auto& s : stretches)
    for (int k = 0; k < 20; ++k) {
      const Mat3 Q = random.rotation(), V = random.rotation();
      const Mat3 F = Q * V * Vec3(s[0], s[1], s[2]).asDiagonal() * V.transpose();
      // Round-off in F is |F| 1e-16; it turns R by that over the sum of the two smallest stretches.
      const double tolerance = 1e-15 * 20 * s[0] / (s[1] + s[2]);
      EXPECT_LT((polar_rotation(F) - Q).norm(), tolerance) << F;
      EXPECT_LT((polar_in_lane(F, k % lanes) - Q).norm(), tolerance) << F;
    }
}

TEST(Polar, IsARotationForEveryGradient) {
  Random random;
  std::vector<Mat3> gradients{Mat3::Zero(),
                              -Mat3::Identity(),
                              Mat3::Ones(),
                              Vec3(1, 1, -1).asDiagonal(),
                              Vec3(1, 0, 0).asDiagonal(),
                              1e-200 * Mat3::Identity(),
                              1e100 * random.matrix()};
  for (int k = 0; k < 200; ++k) gradients.push_back(random.matrix());
  for (const Mat3& F : gradients)
    for (const Mat3& R : {polar_rotation(F), polar_in_lane(F, 5)}) {
      EXPECT_NEAR(R.determinant(), 1, 1e-13) << F;
      EXPECT_LT((R * R.transpose() - Mat3::Identity()).norm(), 1e-13) << F;
      EXPECT_LT((R.transpose() * F - F.transpose() * R).norm(), 1e-12 * (F.norm() + 1e-300)) << F;
    }
}

TEST(Polar, IsNearerThanAnyOtherRotation) {
  Random random;
  for (int k = 0; k < 50; ++k) {
    const Mat3 F = random.matrix();
    const double best = (F - polar_rotation(F)).norm();
    for (int trial = 0; trial < 50; ++trial) EXPECT_LE(best, (F - random.rotation()).norm() + 1e-14);
  }
}

}  // namespace
}  // namespace msml::fe
