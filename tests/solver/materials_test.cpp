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

/// Whether the fibres of sample_value are stretched or slack by 0.05 or more: between them, laws of fibres that bear
/// tension alone have a kink in their stress.
bool fibres_are_decided(const Mat3& F) {
  const double J = std::abs(F.determinant()), factor = std::pow(J, -2.0 / 3), x = factor * F.squaredNorm() - 3;
  for (const Vec3& g : {Vec3(1, 2, -0.5), Vec3(-1, 0.3, 2)}) {
    const double square = (F * g.normalized()).squaredNorm();
    if (std::abs(square - 1) < 0.05 || std::abs(0.1 * x + 0.7 * (factor * square - 1)) < 0.05) return false;
  }
  return true;
}

/// Near rest, strongly stretched, squeezed, and inverted; at least 0.1 away from places where the rotation is not
/// unique or a stretch is 0.
std::vector<Mat3> sample_gradients(Random& random, const Law& law) {
  std::vector<Mat3> samples;
  const auto add = [&](const auto& draw) {
    Mat3 F = draw();
    while (!law.isotropic() && !fibres_are_decided(F)) F = draw();
    samples.push_back(F);
  };
  for (int k = 0; k < 5; ++k) {
    add([&] { return Mat3(Mat3::Identity() + 0.2 * random.matrix()); });
    add([&] { return random.stretched(2, 1.5, 0.4); });
    add([&] { return random.stretched(0.5, 1.1, 0.4); });
    if (!law.survives_inversion() && law.name() != "linearElasticMaterial") continue;
    add([&] { return random.stretched(0.2, 1.1, 0.1); });
    add([&] { return random.stretched(1.3, 0.9, -0.4); });
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

/// Derivative at 0 of f along a line, by central differences of sixth order: the error h^6 |f^(7)| / 140 stays below
/// 1e-12 of |f''| where nothing is singular within 0.05 or so, and round-off is 1e-16 |f| / h.
template <class F>
auto slope(F&& f) {
  const double h = 1e-3;
  return ((45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h)).eval();
}

TEST(EveryMaterial, StressIsDerivativeOfEnergy) {
  Random random;
  for (const auto& [name, law] : all_laws())
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Mat3 d = random.matrix();
      const auto energy = [&](double t) { return Eigen::Matrix<double, 1, 1>(evaluate(*law, F + t * d).energy); };
      const Point point = evaluate(*law, F);
      EXPECT_NEAR(point.P.cwiseProduct(d).sum(), slope(energy)(0), 1e-10 * point.tangent.norm()) << name << "\n" << F;
    }
}

TEST(EveryMaterial, TangentIsDerivativeOfStress) {
  Random random;
  int checked = 0;
  for (const auto& [name, law] : all_laws()) {
    if (!law->exact_tangent()) continue;
    ++checked;
    for (const Mat3& F : sample_gradients(random, *law)) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> d = random.matrix();
      const Mat3 expected = slope([&](double t) { return evaluate(*law, F + t * d).P; });
      const Point point = evaluate(*law, F);
      const Eigen::Matrix<double, 9, 1> product =
          point.tangent * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(d.data());
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(product[k], expected(k / 3, k % 3), 1e-10 * point.tangent.norm()) << name << "\n" << F;
    }
  }
  EXPECT_GE(checked, 40);
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
    if (!law->isotropic()) continue;
    const double mu = law->shear_modulus(), nu = law->poisson_ratio(), lambda = 2 * mu * nu / (1 - 2 * nu);
    const Mat3 direction = random.matrix();
    const auto error = [&](double size) {
      const Mat3 H = size * direction, e = 0.5 * (H + H.transpose());
      const Mat3 expected = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
      return (evaluate(*law, Mat3::Identity() + H).P - expected).norm();
    };
    // Of second order in the strain, with a third of 1e-4 of it beside; 1e-15 is round-off.
    EXPECT_LT(error(5e-5), 0.251 * error(1e-4) + 1e-15 * (mu + lambda)) << name;
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

// w(s, y, z) is quadratic in s, so that what inversion = "clamped" would continue it by is the law itself.
TEST(LinearElastic, IsItsOwnContinuationBelowAStretch) {
  const double c = 0.3, h = 1e-3, young = 1000, nu = 0.3, M = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const auto law = law_of("linearElasticMaterial", {{"strain", std::string("corotated")},
                                                    {"inversion", std::string("clamped")},
                                                    {"youngModulus", young},
                                                    {"poissonRatio", nu}});
  EXPECT_TRUE(law->survives_inversion());
  EXPECT_FALSE(make_linear_elastic({})->survives_inversion());
  const auto w = [&](double s) { return evaluate(*law, Vec3(1.1, 0.9, s).asDiagonal()).energy; };
  const double slope = (w(c + h) - w(c - h)) / (2 * h);
  for (const double s : {0.1, -0.2, -0.7})
    EXPECT_NEAR(w(s), w(c) + slope * (s - c) + 0.5 * M * (s - c) * (s - c), 1e-8 * M) << s;
  EXPECT_THROW(
      law_of("linearElasticMaterial", {{"strain", std::string("small")}, {"inversion", std::string("clamped")}}),
      Error);
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
