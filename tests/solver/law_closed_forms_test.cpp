// SPDX-License-Identifier: GPL-3.0-or-later
// Laws against closed forms and against each other.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "solver/materials/law.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using Law_ = std::shared_ptr<const Law>;

Mat3 stretch(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

/// A bar stretched to l with free sides: nominal stress and lateral stretch, by bisection of the lateral stress.
std::pair<double, double> uniaxial(const Law& law, double l) {
  double low = 0.3, high = 1.6;
  while (high - low > 1e-15) {
    const double s = 0.5 * (low + high);
    (evaluate(law, stretch(l, s, s)).P(1, 1) > 0 ? high : low) = s;
    if (s == low && s == 0.5 * (low + high)) break;
  }
  return {evaluate(law, stretch(l, low, low)).P(0, 0), low};
}

/// The nominal stress of an incompressible bar: the lateral stress determines the pressure.
double incompressible_bar(const Law& law, double l) {
  const double s = 1 / std::sqrt(l);
  const Mat3 P = evaluate(law, stretch(l, s, s)).P;
  return P(0, 0) - P(1, 1) * s / l;
}

// Numbers of W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2, printed with nine digits.
TEST(NeoHookean, BarFollowsTheClosedForm) {
  const Law_ law = law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
  EXPECT_NEAR(uniaxial(*law, 0.7).first, -405.230424, 1e-6);
  EXPECT_NEAR(uniaxial(*law, 0.7).second, 1.10793473, 1e-8);
  EXPECT_NEAR(uniaxial(*law, 1.2).first, 174.929147, 1e-6);
  EXPECT_NEAR(uniaxial(*law, 1.5).first, 378.280176, 1e-6);
  EXPECT_NEAR(uniaxial(*law, 1.5).second, 0.88017459, 1e-8);
  EXPECT_NEAR(uniaxial(*law, 2).first, 646.744660, 1e-6);
  EXPECT_NEAR(uniaxial(*law, 2).second, 0.79807754, 1e-8);
}

TEST(NeoHookean, SimpleShearHasANormalStressDifference) {
  const double E = 1000, nu = 0.3, mu = E / (2 * (1 + nu)), g = 0.8;
  Gradients H{};
  H(0, 1) += g;
  for (const char* form : {"log", "cubic", "isochoric"}) {
    Measures m;
    law_of("neoHookeanMaterial", {{"youngModulus", E}, {"poissonRatio", nu}, {"form", std::string(form)}})
        ->measure({&H, 1}, {&m, 1});
    EXPECT_NEAR(m.cauchy(0, 1)[0], mu * g, 1e-10) << form;
    EXPECT_NEAR(m.cauchy(0, 0)[0] - m.cauchy(1, 1)[0], mu * g * g, 1e-10) << form;
    EXPECT_NEAR(m.strain(1, 1)[0], g * g / 2, 1e-15) << form;
  }
}

TEST(NeoHookean, CubicFormHasALocalMinimumWhereABodyIsPressedToAPoint) {
  const Law_ law = law_of("neoHookeanMaterial", {{"form", std::string("cubic")}});
  const Point point = evaluate(*law, Mat3::Zero());
  EXPECT_EQ(point.P.norm(), 0);
  EXPECT_LT((point.tangent - law->shear_modulus() * Eigen::Matrix<double, 9, 9>::Identity()).norm(), 1e-9);
  EXPECT_GT(point.energy, 0);
}

// Psi = m/2 (I1 - 3) + l/2 (J - alpha)^2 - m/2 ln(I1 + 1) - its value at rest, with m = 4/3 mu, l = lambda + 5/6 mu and
// alpha = 1 + m/l - m/(4 l), as published.
TEST(NeoHookean, StableFormIsThePublishedEnergy) {
  const double E = 1000, nu = 0.4, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const double m = 4 * mu / 3, l = lambda + 5 * mu / 6, alpha = 1 + 0.75 * m / l;
  const auto psi = [&](const Mat3& F) {
    const double I1 = F.squaredNorm(), J = F.determinant();
    return m / 2 * (I1 - 3) + l / 2 * (J - alpha) * (J - alpha) - m / 2 * std::log(I1 + 1);
  };
  const Law_ law =
      law_of("neoHookeanMaterial", {{"youngModulus", E}, {"poissonRatio", nu}, {"form", std::string("stable")}});
  Random random;
  for (const Mat3& F : {random.stretched(2, 1.2, 0.3), random.stretched(1.5, 0.2, -0.7), Mat3(Mat3::Zero())})
    EXPECT_NEAR(evaluate(*law, F).energy, psi(F) - psi(Mat3::Identity()), 1e-9);
}

TEST(SaintVenantKirchhoff, BarFollowsTheClosedFormAndSoftensInCompression) {
  const double E = 1000;
  const Law_ law = law_of("stVenantKirchhoffMaterial", {{"youngModulus", E}, {"poissonRatio", 0.3}});
  for (const double l : {0.5, 0.8, 1.5}) EXPECT_NEAR(uniaxial(*law, l).first, E / 2 * l * (l * l - 1), 1e-9);
  EXPECT_NEAR(uniaxial(*law, 1.5).first, 937.5, 1e-9);
  const double turn = 1 / std::sqrt(3);
  EXPECT_GT(uniaxial(*law, turn - 0.01).first, uniaxial(*law, turn).first);
  EXPECT_GT(uniaxial(*law, turn + 0.01).first, uniaxial(*law, turn).first);
}

TEST(MooneyRivlin, BarAndSheetFollowTheClosedForms) {
  const Law_ law = law_of("mooneyRivlinMaterial", {{"c1", 1.0}, {"c2", 0.1}});
  EXPECT_NEAR(incompressible_bar(*law, 0.7), -3.0647230, 5e-8);
  EXPECT_NEAR(incompressible_bar(*law, 1.5), 2.2518519, 5e-8);
  EXPECT_NEAR(incompressible_bar(*law, 2), 3.675, 1e-12);
  EXPECT_NEAR(incompressible_bar(*law, 3), 5.9703704, 5e-8);
  const auto sheet = [&](double l) {
    const Mat3 P = evaluate(*law, stretch(l, l, 1 / (l * l))).P;
    return P(0, 0) * l - P(2, 2) / (l * l);
  };
  EXPECT_NEAR(sheet(1.5), 5.0285494, 5e-8);
  EXPECT_NEAR(sheet(2), 11.025, 1e-12);
}

TEST(ReducedPolynomial, BarFollowsTheClosedForm) {
  const std::vector<double> c{2, -0.3, 0.05};
  const Law_ law = law_of("reducedPolynomialMaterial", {{"c", c}});
  for (const double l : {0.6, 1.3, 2.0}) {
    const double x = l * l + 2 / l - 3, slope = c[0] + 2 * c[1] * x + 3 * c[2] * x * x;
    EXPECT_NEAR(incompressible_bar(*law, l), 2 * (l - 1 / (l * l)) * slope, 1e-12);
  }
}

TEST(Ogden, BarFollowsTheClosedForm) {
  const Law_ law =
      law_of("ogdenMaterial", {{"mu", std::vector<double>{6, -0.4}}, {"alpha", std::vector<double>{1.3, -2}}});
  for (const double l : {0.6, 1.3, 3.0}) {
    const double one = 6 * (std::pow(l, 0.3) - std::pow(l, -1.65)), two = -0.4 * (std::pow(l, -3) - std::pow(l, 0));
    EXPECT_NEAR(incompressible_bar(*law, l), one + two, 1e-12);
  }
}

void expect_same(const Law& one, const Law& two, const Mat3& F, double relative) {
  const Point a = evaluate(one, F), b = evaluate(two, F);
  const double size = a.tangent.norm() * relative;
  EXPECT_NEAR(a.energy, b.energy, size) << F;
  EXPECT_LT((a.P - b.P).norm(), size) << F;
  EXPECT_LT((a.tangent - b.tangent).norm(), size) << F;
}

// Two stretches equal or nearly so are where divided differences of stresses lose digits.
std::vector<Mat3> with_equal_stretches(Random& random) {
  return {Mat3::Identity(),
          random.stretched(1.7, 1.7, 1.7),
          random.stretched(0.6, 1.7, 1.7),
          random.stretched(1.7, 0.6, 0.6 + 1e-9),
          random.stretched(1.7, 1.7 + 1e-6, 0.6),
          random.stretched(1.4, 1.4 - 1e-13, 1.4 + 1e-4),
          random.stretched(2, 1.2, 0.4)};
}

TEST(Ogden, ContainsNeoHookeanAndMooneyRivlin) {
  const auto list = [](double a, double b) { return std::vector<double>{a, b}; };
  const Law_ ogden = law_of("ogdenMaterial", {{"mu", list(400, -120)}, {"alpha", list(2, -2)}}),
             mooney = law_of("mooneyRivlinMaterial", {{"c1", 200.0}, {"c2", 60.0}}),
             polynomial = law_of("polynomialMaterial", {{"terms", std::vector<double>{1, 0, 200, 0, 1, 60}}});
  Random random;
  for (const Mat3& F : with_equal_stretches(random)) {
    expect_same(*ogden, *mooney, F, 1e-12);
    expect_same(*polynomial, *mooney, F, 1e-13);
  }
}

TEST(ReducedPolynomial, OfOneTermIsTheIsochoricNeoHookeanLaw) {
  const double mu = 1000 / 2.6, kappa = 1000 / 1.2;
  const Law_ one = law_of("reducedPolynomialMaterial", {{"c", std::vector<double>{mu / 2}}, {"bulkModulus", kappa}}),
             two = law_of("neoHookeanMaterial",
                          {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}, {"form", std::string("isochoric")}});
  Random random;
  for (const Mat3& F : with_equal_stretches(random)) expect_same(*one, *two, F, 1e-12);
}

TEST(VolumetricEnergies, HaveTheirClosedFormsAndOneBulkModulus) {
  const double kappa = 1500, J = 1.3;
  const Mat3 F = std::cbrt(J) * Mat3::Identity();
  const auto energy = [&](const char* name) {
    return evaluate(*law_of("mooneyRivlinMaterial", {{"volumetric", std::string(name)}, {"bulkModulus", kappa}}), F)
        .energy;
  };
  EXPECT_NEAR(energy("lnJ2"), kappa / 2 * std::log(J) * std::log(J), 1e-11);
  EXPECT_NEAR(energy("J1"), kappa / 2 * 0.09, 1e-11);
  EXPECT_NEAR(energy("I3"), kappa / 8 * 0.69 * 0.69, 1e-11);
}

TEST(TransverselyIsotropic, FibresActAlongAndAt45DegreesButNotAcross) {
  const double k1 = 300, k2 = 0.4, l = 1.4, f = l * l - 1;
  const auto fibre_stress = [&](const char* direction) {
    const std::map<std::string, Value> with{{"fiber", std::string(direction)}, {"k1", k1}, {"k2", k2}};
    const Law_ law = law_of("transverselyIsotropicMaterial", with),
               matrix = law_of("neoHookeanMaterial", {{"poissonRatio", 13.0 / 15 * 1.5 - 1}});
    return Mat3(evaluate(*law, stretch(l, 1, 1)).P - evaluate(*matrix, stretch(l, 1, 1)).P);
  };
  const auto slope = [&](double x) { return k1 * x * std::exp(k2 * x * x); };  // dPsi/df
  EXPECT_NEAR(fibre_stress("2 0 0")(0, 0), 2 * slope(f) * l, 1e-9);
  EXPECT_LT(fibre_stress("0 1 0").norm(), 1e-9);
  const Mat3 diagonal = fibre_stress("1 1 0");  // g . C g = (l^2 + 1)/2; P = 2 dPsi/df F g g^T
  EXPECT_NEAR(diagonal(0, 0), slope(f / 2) * l, 1e-9);
  EXPECT_NEAR(diagonal(0, 1), slope(f / 2) * l, 1e-9);
  EXPECT_NEAR(diagonal(1, 0), slope(f / 2), 1e-9);
}

TEST(TransverselyIsotropic, FibresBearNoCompression) {
  const Mat3 F = stretch(0.7, 1, 1);
  const Law_ along = law_of("transverselyIsotropicMaterial", {{"fiber", std::string("1 0 0")}}),
             none = law_of("transverselyIsotropicMaterial", {{"fiber", std::string("1 0 0")}, {"k1", 0.0}});
  expect_same(*along, *none, F, 1e-14);
}

TEST(HolzapfelGasserOgden, WithFullDispersionHasNoDirection) {
  const double mu = 200, k1 = 300, k2 = 0.4;
  const auto law = [&](const char* fibre) {
    return law_of("holzapfelGasserOgdenMaterial", {{"mu", mu},
                                                   {"k1", k1},
                                                   {"k2", k2},
                                                   {"kappa", 1.0 / 3},
                                                   {"fiber", std::string(fibre)},
                                                   {"fiber2", std::monostate()}});
  };
  const Mat3 F = stretch(1.5, 1 / 1.5, 1);
  const double x = F.squaredNorm() - 3;
  EXPECT_NEAR(evaluate(*law("1 0 0"), F).energy, mu / 2 * x + k1 / (2 * k2) * std::expm1(k2 * x * x / 9), 1e-10);
  expect_same(*law("1 0 0"), *law("1 2 3"), F, 1e-13);
}

TEST(HolzapfelGasserOgden, FamiliesAddUp) {
  const double k1 = 300, k2 = 0.4, l = 1.3;
  const auto energy = [&](const Value& second) {
    const Law_ law = law_of(
        "holzapfelGasserOgdenMaterial",
        {{"mu", 200.0}, {"k1", k1}, {"k2", k2}, {"kappa", 0.0}, {"fiber", std::string("0 0 1")}, {"fiber2", second}});
    return evaluate(*law, stretch(l, 1 / l, 1)).energy;
  };
  const double f = l * l - 1;
  EXPECT_NEAR(energy(std::string("1 0 0")) - energy(std::monostate()), k1 / (2 * k2) * std::expm1(k2 * f * f), 1e-10);
}

TEST(Guccione, HasItsThreeModuli) {
  const double C = 500, bf = 1.8, bt = 0.9, bfs = 1.3;
  const Law_ law = law_of("guccioneMaterial", {{"C", C}, {"fiber", std::string("0 1 0")}});
  const double l = 1.3, e = (l * l - 1) / 2, kappa = 1500, g = 0.4;
  const auto energy = [&](double Q, double J) { return C / 2 * std::expm1(Q) + kappa / 2 * std::log(J) * std::log(J); };
  EXPECT_NEAR(evaluate(*law, stretch(1, l, 1)).energy, energy(bf * e * e, l), 1e-10);
  EXPECT_NEAR(evaluate(*law, stretch(1, 1, l)).energy, energy(bt * e * e, l), 1e-10);
  Mat3 shear = Mat3::Identity();  // E_fs = g/2 between fibre y and z, E_zz = g^2/2
  shear(1, 2) = g;
  EXPECT_NEAR(evaluate(*law, shear).energy, energy(bt * std::pow(g, 4) / 4 + bfs * g * g / 2, 1), 1e-10);
}

TEST(Clamped, IsTheLawItselfAboveTheThreshold) {
  Random random;
  const std::map<std::string, Value> set{{"clampedBelow", 0.3}, {"inversion", std::string("clamped")}};
  const Law_ clamped = law_of("neoHookeanMaterial", set), natural = law_of("neoHookeanMaterial");
  for (const Mat3& F : {random.stretched(2, 1, 0.5), random.stretched(3, 2, 0.31), Mat3(Mat3::Identity())})
    expect_same(*clamped, *natural, F, 1e-14);
}

// Along one stretch below c the energy is w(c) + w'(c) (s - c) + k (s - c)^2.
TEST(Clamped, ContinuesALawByItsTangent) {
  const double E = 1000, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), c = 0.4;
  const Law_ law =
      law_of("neoHookeanMaterial",
             {{"youngModulus", E}, {"poissonRatio", nu}, {"clampedBelow", c}, {"inversion", std::string("clamped")}});
  const double w = mu / 2 * (c * c - 1) - mu * std::log(c) + lambda / 2 * std::log(c) * std::log(c);
  const double slope = mu * (c - 1 / c) + lambda * std::log(c) / c;
  for (const double s : {0.39, 0.0, -0.5}) {
    const Point point = evaluate(*law, stretch(1, s, 1));
    EXPECT_NEAR(point.energy, w + slope * (s - c) + (lambda + 2 * mu) / 2 * (s - c) * (s - c), 1e-9);
    EXPECT_NEAR(point.P(1, 1), slope + (lambda + 2 * mu) * (s - c), 1e-9);
    EXPECT_LT(point.P(1, 1), 0) << "pushes back to the right side";
  }
}

TEST(MergedLaws, HaveTheParametersOfEachLane) {
  Random random;
  for (const MaterialFactory& material : materials()) {
    std::vector<Law_> laws;
    for (int lane = 0; lane < lanes; ++lane) {
      std::map<std::string, Value> set;
      for (const Slot& slot : material.slots())
        if (slot.type == Type::formula && slot.name != "clampedBelow") {
          const Value sample = sample_value(slot);
          const auto* number = std::get_if<double>(&sample);
          const double value = number != nullptr ? *number : std::get<Formula>(sample).number;
          set[slot.name] =
              value + 0.1 * lane / lanes * (std::isfinite(slot.range.high) ? slot.range.high - value : value);
        }
      for (const char* name : {"mu", "alpha", "c"})
        if (const int slot = material.find(name);
            slot >= 0 && material.slots()[static_cast<std::size_t>(slot)].type == Type::numbers) {
          auto list = std::get<std::vector<double>>(sample_value(material.slots()[static_cast<std::size_t>(slot)]));
          for (double& x : list) x *= 1 + 0.1 * lane;
          set[name] = list;
        }
      if (material.find("fiber") >= 0) set["fiber"] = fmt::format("1 {} 2", lane);
      laws.push_back(material.make(sample_record(material, set)));
    }
    const Law_ merged = laws.front()->merged(laws);
    ASSERT_NE(merged, nullptr) << material.tag();
    const Mat3 F = random.stretched(1.5, 1.2, 0.7);
    for (const int lane : {0, 3, 7}) {
      EXPECT_EQ(evaluate(*merged, F, Want::tangent, lane).P, evaluate(*laws[static_cast<std::size_t>(lane)], F).P)
          << material.tag();
    }
    EXPECT_NE(evaluate(*merged, F, Want::tangent, 0).P, evaluate(*merged, F, Want::tangent, 7).P) << material.tag();
  }
}

TEST(HyperelasticMaterials, RefuseWhatHasNoMeaning) {
  const Value none = std::monostate();
  EXPECT_THROW(law_of("mooneyRivlinMaterial", {{"bulkModulus", none}}), Error);
  EXPECT_THROW(law_of("mooneyRivlinMaterial", {{"incompressible", true}}), Error);
  EXPECT_NO_THROW(law_of("mooneyRivlinMaterial", {{"bulkModulus", none}, {"incompressible", true}}));
  EXPECT_THROW(law_of("mooneyRivlinMaterial", {{"c1", -1.0}, {"c2", 0.5}}), Error);
  EXPECT_THROW(law_of("neoHookeanMaterial", {{"poissonRatio", none}}), Error);
  EXPECT_THROW(law_of("neoHookeanMaterial", {{"incompressible", true}}), Error);
  EXPECT_THROW(law_of("neoHookeanMaterial", {{"volumetric", std::string("J1")}}), Error);
  EXPECT_THROW(law_of("polynomialMaterial", {{"terms", std::vector<double>{0.5, 0, 1}}}), Error);
  EXPECT_THROW(law_of("ogdenMaterial", {{"mu", std::vector<double>{1}}, {"alpha", std::vector<double>{-1}}}), Error);
  EXPECT_THROW(law_of("ogdenMaterial", {{"mu", std::vector<double>{1, 2}}, {"alpha", std::vector<double>{1}}}), Error);
  EXPECT_THROW(law_of("guccioneMaterial", {{"fiber", std::string("0 0 0")}}), Error);
  EXPECT_THROW(law_of("guccioneMaterial", {{"fiber", std::string("fibres")}}), Error);
}

TEST(IncompressibleLaws, SplitWithAnInfiniteModulus) {
  for (const char* tag : {"mooneyRivlinMaterial", "ogdenMaterial", "holzapfelGasserOgdenMaterial"}) {
    const Law_ law = law_of(tag, {{"bulkModulus", std::monostate()}, {"incompressible", true}});
    EXPECT_TRUE(law->incompressible());
    EXPECT_EQ(law->poisson_ratio(), 0.5);
    ASSERT_TRUE(law->split());
    EXPECT_TRUE(std::isinf(law->split()->modulus[0]));
  }
  const Law_ rubber = law_of("neoHookeanMaterial",
                             {{"poissonRatio", std::monostate()}, {"incompressible", true}, {"youngModulus", 3.0}});
  EXPECT_EQ(rubber->shear_modulus(), 1);
}

}  // namespace
}  // namespace msml::fe
