// SPDX-License-Identifier: GPL-3.0-or-later
// Laws taken apart into a volumetric term and the rest.
#include <gtest/gtest.h>

#include "solver/materials/linear_elastic.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using namespace testing;

TEST(SplitLaws, AddUpToTheWhole) {
  Random random;
  int checked = 0;
  for (const auto& [name, law] : all_laws()) {
    const auto split = law->split();
    if (!split || law->incompressible()) continue;
    ++checked;
    for (const Mat3& F : {Mat3(Mat3::Identity() + 0.1 * random.matrix()), random.stretched(2, 1.5, 0.4)}) {
      const Point whole = evaluate(*law, F), rest = evaluate(*split->rest, F), g = evaluate(*split->constraint, F);
      const double m = split->modulus[0], size = law->shear_modulus() + m;
      EXPECT_NEAR(whole.energy, rest.energy + m / 2 * g.energy * g.energy, 1e-13 * size) << name;
      EXPECT_LT((whole.P - rest.P - m * g.energy * g.P).norm(), 1e-13 * size) << name;
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> slope = g.P;
      const Eigen::Map<const Eigen::Matrix<double, 9, 1>> d(slope.data());
      if (!law->exact_tangent()) continue;
      // The tangent of the corotated law grows to 1e2 times the modulus near equal negative stretches.
      EXPECT_LT((whole.tangent - rest.tangent - m * g.energy * g.tangent - m * d * d.transpose()).norm(), 1e-12 * size)
          << name;
    }
  }
  EXPECT_GE(checked, 5);
}

TEST(SplitLaws, GiveTheDerivativesOfTheirConstraint) {
  Random random;
  const double h = 1e-5;  // central differences: error about 1e-10
  for (const auto& [name, law] : all_laws()) {
    const auto split = law->split();
    if (!split || !law->exact_tangent()) continue;
    for (const Mat3& F : {Mat3(Mat3::Identity() + 0.1 * random.matrix()), random.stretched(2, 1.5, 0.4)}) {
      const Mat3 d = random.matrix();
      const Point g = evaluate(*split->constraint, F), after = evaluate(*split->constraint, F + h * d),
                  before = evaluate(*split->constraint, F - h * d);
      EXPECT_NEAR(g.P.cwiseProduct(d).sum(), (after.energy - before.energy) / (2 * h), 1e-8) << name;
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> row_major = d, slope = (after.P - before.P) / (2 * h);
      EXPECT_LT((g.tangent * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(row_major.data()) -
                 Eigen::Map<const Eigen::Matrix<double, 9, 1>>(slope.data()))
                    .norm(),
                1e-7)
          << name;
    }
  }
}

}  // namespace
}  // namespace msml::fe
