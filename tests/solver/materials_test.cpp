// SPDX-License-Identifier: GPL-3.0-or-later
// What every material law must satisfy, for every law of the registry.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "msml/core/error.hpp"
#include "solver/materials/linear_elastic.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// Near rest, strongly stretched, squeezed, and inverted; away from places where the rotation is not unique.
std::vector<Mat3> sample_gradients(Random& random, const Law& law) {
  std::vector<Mat3> samples;
  for (int k = 0; k < 5; ++k) {
    samples.push_back(Mat3::Identity() + 0.1 * random.matrix());
    samples.push_back(random.stretched(2, 1.5, 0.4));
    samples.push_back(random.stretched(0.5, 1.1, 0.4));
    if (law.survives_inversion()) {
      samples.push_back(random.stretched(0.2, 1.1, 0.1));
      samples.push_back(random.stretched(1.3, 0.9, -0.4));
    }
  }
  return samples;
}

TEST(EveryMaterial, HasNoEnergyAndNoStressAtRest) {
  for (const auto& [name, law] : all_laws()) {
    const Point rest = evaluate(*law, Mat3::Identity());
    EXPECT_EQ(rest.energy, 0) << name;
    EXPECT_LT(rest.P.norm(), 1e-12 * law->shear_modulus()) << name;
  }
}

TEST(EveryMaterial, StressIsDerivativeOfEnergy) {
  Random random;
  const double h = 1e-5;  // central differences: error h^2 |W'''| + 1e-16 |W| / h, both about 1e-10 of the modulus
  for (const auto& [name, law] : all_laws())
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Mat3 direction = random.matrix();
      const double slope =
          (evaluate(*law, F + h * direction).energy - evaluate(*law, F - h * direction).energy) / (2 * h);
      EXPECT_NEAR(evaluate(*law, F).P.cwiseProduct(direction).sum(), slope, 1e-6 * law->shear_modulus()) << name << "\n"
                                                                                                         << F;
    }
}

TEST(EveryMaterial, TangentIsDerivativeOfStress) {
  Random random;
  const double h = 1e-5;
  int checked = 0;
  for (const auto& [name, law] : all_laws()) {
    if (!law->exact_tangent()) continue;
    ++checked;
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Mat3 d = random.matrix();
      const Mat3 slope = (evaluate(*law, F + h * d).P - evaluate(*law, F - h * d).P) / (2 * h);
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> row_major = d;
      const Eigen::Matrix<double, 9, 1> product =
          evaluate(*law, F).tangent * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(row_major.data());
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(product[k], slope(k / 3, k % 3), 1e-6 * law->shear_modulus()) << name << "\n" << F;
    }
  }
  EXPECT_GE(checked, 2);
}

TEST(EveryMaterial, HasASemidefiniteTangentForIndefinitePlaces) {
  Random random;
  for (const auto& [name, law] : all_laws())
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(
          evaluate(*law, F, Want::definite_tangent).tangent);
      EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12 * solver.eigenvalues().maxCoeff()) << name;
    }
}

TEST(EveryMaterial, IsObjective) {
  Random random;
  int checked = 0;
  for (const auto& [name, law] : all_laws()) {
    if (law->small_strain()) continue;
    ++checked;
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Mat3 Q = random.rotation();
      const Point one = evaluate(*law, F), two = evaluate(*law, Q * F);
      EXPECT_NEAR(one.energy, two.energy, 1e-12 * law->shear_modulus() * (1 + F.squaredNorm())) << name;
      EXPECT_LT((Q * one.P - two.P).norm(), 1e-12 * law->shear_modulus() * (1 + F.norm()) * 4) << name;
    }
  }
  EXPECT_GE(checked, 1);
}

TEST(EveryMaterial, ApproachesHookesLawForSmallStrain) {
  Random random;
  for (const auto& [name, law] : all_laws()) {
    const double mu = law->shear_modulus(), nu = law->poisson_ratio(), lambda = 2 * mu * nu / (1 - 2 * nu);
    const double size = 1e-6;
    const Mat3 H = size * random.matrix(), e = 0.5 * (H + H.transpose());
    const Mat3 expected = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
    // Second order in the strain: 1e-12, times a few.
    EXPECT_LT((evaluate(*law, Mat3::Identity() + H).P - expected).norm(), 20 * size * size * (mu + lambda)) << name;
  }
}

TEST(EveryMaterial, GivesTheSameInEveryLane) {
  Random random;
  for (const auto& [name, law] : all_laws())
    for (const Mat3& F : sample_gradients(random, *law))
      for (const int lane : {0, 7}) EXPECT_EQ(evaluate(*law, F).P, evaluate(*law, F, Want::tangent, lane).P) << name;
}

TEST(LinearElastic, RefusesValuesOutsideTheirRange) {
  EXPECT_THROW(make_linear_elastic({.youngs_modulus = 0}), Error);
  EXPECT_THROW(make_linear_elastic({.youngs_modulus = NAN}), Error);
  EXPECT_THROW(make_linear_elastic({.poisson_ratio = 0.5}), Error);
  EXPECT_THROW(make_linear_elastic({.poisson_ratio = -1}), Error);
  EXPECT_NO_THROW(make_linear_elastic({.poisson_ratio = 0.4999}));
}

// Simple shear F = I + g e1 e2^T. U of the plane part is by hand [[2, g], [g, 2 + g^2]] / sqrt(4 + g^2).
TEST(LinearElastic, CorotatedShearStressesFollowTheClosedForm) {
  const double mu = 100, g = 0.8;
  const auto law = make_linear_elastic({.youngs_modulus = 2 * mu, .poisson_ratio = 0});
  Gradients H{};
  H(0, 1) += g;
  Measures measures;
  law->measure({&H, 1}, {&measures, 1});
  EXPECT_NEAR(measures.cauchy(0, 0)[0] - measures.cauchy(1, 1)[0], mu * g * g / std::sqrt(1 + g * g / 4), 1e-10);
  EXPECT_NEAR(measures.strain(0, 1)[0], g / std::sqrt(4 + g * g), 1e-14);
}

TEST(LinearElastic, UsesTheRotatedTangentWithOneSolvePerStepUnlessTold) {
  Random random;
  const Mat3 F = random.stretched(1.5, 1, 0.7);
  const auto automatic = make_linear_elastic({}), rotated = make_linear_elastic({.tangent = TangentKind::rotated}),
             exact = make_linear_elastic({.tangent = TangentKind::exact});
  EXPECT_EQ(evaluate(*automatic, F, Want::single_tangent).tangent, evaluate(*rotated, F).tangent);
  EXPECT_EQ(evaluate(*automatic, F, Want::tangent).tangent, evaluate(*exact, F).tangent);
  EXPECT_NE(evaluate(*exact, F).tangent, evaluate(*rotated, F).tangent);
}

}  // namespace
}  // namespace msml::fe
