// SPDX-License-Identifier: GPL-3.0-or-later
// Stress and tangent of every isotropic law continued through inversion, against nilpotent numbers, to round-off.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <array>
#include <functional>

#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// A number with e_i^2 = 0 for five e_i: bits 0 and 1 of an index stand for two directions of F, bits 2 to 4 for the
/// steps below the bound along the three stretches.
struct Series {
  std::array<double, 32> c{};
  Series() = default;
  Series(double x) { c[0] = x; }  // NOLINT: numbers mix freely
  static Series step(int bit) {
    Series s;
    s.c[std::size_t{1} << bit] = 1;
    return s;
  }
};

Series operator+(Series x, const Series& y) {
  for (std::size_t i = 0; i < 32; ++i) x.c[i] += y.c[i];
  return x;
}
Series operator*(const Series& x, const Series& y) {
  Series z;
  for (std::size_t i = 0; i < 32; ++i)
    for (std::size_t j = 0; j < 32; ++j)
      if ((i & j) == 0) z.c[i | j] += x.c[i] * y.c[j];
  return z;
}
Series operator-(const Series& x) { return -1.0 * x; }
Series operator-(const Series& x, const Series& y) { return x + -y; }

/// f(x) from its Taylor coefficients at x.c[0]: the fifth power of what is beside it is the last that is not 0.
Series of_taylor(const Series& x, const std::array<double, 6>& f) {
  Series beside = x, sum = f[5];
  beside.c[0] = 0;
  for (int k = 4; k >= 0; --k) sum = sum * beside + f[static_cast<std::size_t>(k)];
  return sum;
}
Series power(const Series& x, double a) {
  std::array<double, 6> f{std::pow(x.c[0], a)};
  for (int k = 1; k < 6; ++k) {
    const auto n = static_cast<std::size_t>(k);
    f[n] = f[n - 1] * (a - k + 1) / (k * x.c[0]);
  }
  return of_taylor(x, f);
}
Series logarithm(const Series& x) {
  std::array<double, 6> f{std::log(x.c[0])};
  for (int k = 1; k < 6; ++k) f[static_cast<std::size_t>(k)] = (k % 2 ? 1 : -1) / (k * std::pow(x.c[0], k));
  return of_taylor(x, f);
}

using Stretched = std::array<Series, 3>;
using Energy = std::function<Series(const Stretched&)>;

Series volume(const Stretched& s) { return s[0] * s[1] * s[2]; }
Series first(const Stretched& s) { return s[0] * s[0] + s[1] * s[1] + s[2] * s[2]; }
Series second(const Stretched& s) {
  const Series x = s[0] * s[0], y = s[1] * s[1], z = s[2] * s[2];
  return x * y + y * z + z * x;
}

/// The signed principal stretches of F as roots of det(C - x) = 0, which Newton's iteration carries to all orders.
Stretched stretches(const std::array<Series, 9>& F) {
  const auto f = [&](int i, int k) { return F[static_cast<std::size_t>(3 * i + k)]; };
  Series trace, squares, J;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      Series entry;
      for (int m = 0; m < 3; ++m) entry = entry + f(m, i) * f(m, k);
      squares = squares + entry * entry;
      if (i == k) trace = trace + entry;
    }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    J = J + f(0, i) * (f(1, j) * f(2, k) - f(1, k) * f(2, j));
  }
  const Series minors = 0.5 * (trace * trace - squares), square = J * J;
  Mat3 value;
  for (int i = 0; i < 9; ++i) value(i / 3, i % 3) = F[static_cast<std::size_t>(i)].c[0];
  const Vec3 s = Eigen::JacobiSVD<Mat3>(value).singularValues();
  Stretched roots;
  for (std::size_t i = 0; i < 3; ++i) {
    Series x = s[static_cast<Eigen::Index>(i)] * s[static_cast<Eigen::Index>(i)];
    for (int iteration = 0; iteration < 6; ++iteration) {
      const Series residual = x * x * x - trace * x * x + minors * x - square;
      x = x - residual * power(3.0 * x * x - 2.0 * trace * x + minors, -1);
    }
    roots[i] = (i == 2 && value.determinant() < 0 ? -1.0 : 1.0) * power(x, 0.5);
  }
  return roots;
}

/// The energy along every stretch below c by its tangent at c and stiffness/2 (s - c)^2, one after the other.
Series continued(const Energy& energy, const Stretched& s, double c, double stiffness) {
  Stretched at = s;
  Series added;
  for (std::size_t i = 0; i < 3; ++i) {
    if (s[i].c[0] >= c) continue;
    at[i] = c + Series::step(2 + static_cast<int>(i));
    added = added + 0.5 * stiffness * (s[i] - c) * (s[i] - c);
  }
  const Series raw = energy(at);
  Series sum = added;
  for (std::size_t k = 0; k < 32; ++k) {
    Series term = Series(0);
    term.c[k & 3U] = raw.c[k];
    for (std::size_t i = 0; i < 3; ++i)
      if (k >> (2 + i) & 1U) term = term * (s[i] - c);
    sum = sum + term;
  }
  return sum;
}

struct Case {
  std::string tag;
  std::map<std::string, Value> attributes;
  Energy energy;  ///< by hand from the law's definition
};

constexpr double young = 1000, poisson = 0.3, shear = young / 2.6, lambda = shear * 0.6 / 0.4, bulk = 1500;

Series volumetric(const std::string& name, double modulus, const Series& J) {
  const Series g = name == "lnJ2" ? logarithm(J) : name == "J1" ? J - 1.0 : 0.5 * (J * J - 1.0);
  return 0.5 * modulus * g * g;
}

std::vector<Case> of_hookes_constants() {
  const auto neo_hookean = [](const char* form) {
    return std::map<std::string, Value>{
        {"youngModulus", young}, {"poissonRatio", poisson}, {"form", std::string(form)}};
  };
  const auto with_logarithm = [](const Stretched& s, const Series& log) {
    return 0.5 * shear * (first(s) - 3.0) - shear * log + 0.5 * lambda * log * log;
  };
  return {{"stVenantKirchhoffMaterial",
           {{"youngModulus", young}, {"poissonRatio", poisson}},
           [](const Stretched& s) {
             Series trace, squares;
             for (const Series& x : s) {
               const Series strain = 0.5 * (x * x - 1.0);
               trace = trace + strain;
               squares = squares + strain * strain;
             }
             return shear * squares + 0.5 * lambda * trace * trace;
           }},
          {"neoHookeanMaterial", neo_hookean("log"),
           [=](const Stretched& s) { return with_logarithm(s, logarithm(volume(s))); }},
          {"neoHookeanMaterial", neo_hookean("cubic"),
           [=](const Stretched& s) {
             const Series j = volume(s) - 1.0;
             return with_logarithm(s, j - 0.5 * j * j + (1.0 / 3) * j * j * j);
           }},
          {"neoHookeanMaterial", neo_hookean("stable"), [](const Stretched& s) {
             const double m = 4 * shear / 3, l = lambda + 5 * shear / 6, alpha = 1 + 0.75 * m / l;
             const Series j = volume(s) - alpha;
             return 0.5 * m * (first(s) - 3.0) + 0.5 * l * j * j - 0.5 * m * logarithm(first(s) + 1.0);
           }}};
}

std::vector<Case> of_isochoric_invariants(const std::string& measure) {
  using List = std::vector<double>;
  const auto x = [](const Stretched& s) { return first(s) * power(volume(s), -2.0 / 3) - 3.0; };
  const auto y = [](const Stretched& s) { return second(s) * power(volume(s), -4.0 / 3) - 3.0; };
  const auto law = [&](const char* tag, std::map<std::string, Value> values, auto isochoric) {
    const double modulus = values.contains("youngModulus") ? lambda + 2 * shear / 3 : bulk;
    values["volumetric"] = measure;
    if (modulus == bulk) values["bulkModulus"] = bulk;
    return Case{tag, values,
                [=](const Stretched& s) { return isochoric(s) + volumetric(measure, modulus, volume(s)); }};
  };
  return {law("neoHookeanMaterial",
              {{"youngModulus", young}, {"poissonRatio", poisson}, {"form", std::string("isochoric")}},
              [=](const Stretched& s) { return 0.5 * shear * x(s); }),
          law("mooneyRivlinMaterial", {{"c1", 200.0}, {"c2", 60.0}},
              [=](const Stretched& s) { return 200.0 * x(s) + 60.0 * y(s); }),
          law("reducedPolynomialMaterial", {{"c", List{200, -20, 6}}},
              [=](const Stretched& s) { return x(s) * (200.0 + x(s) * (-20.0 + 6.0 * x(s))); }),
          law("polynomialMaterial", {{"terms", List{1, 0, 200, 0, 1, 60, 1, 1, 12, 2, 0, 9}}},
              [=](const Stretched& s) { return 200.0 * x(s) + 60.0 * y(s) + 12.0 * x(s) * y(s) + 9.0 * x(s) * x(s); }),
          law("ogdenMaterial", {{"mu", List{400, -150}}, {"alpha", List{1.3, -2.2}}}, [](const Stretched& s) {
            const Series third = power(volume(s), -1.0 / 3);
            Series sum;
            for (const Series& l : s)
              sum = sum + 400 / 1.3 * (power(third * l, 1.3) - 1.0) + -150 / -2.2 * (power(third * l, -2.2) - 1.0);
            return sum;
          })};
}

/// Energy, stress along one direction and tangent along two, all to 1e-10 of the tangent's norm.
void compare(const Case& law, const Mat3& F, Random& random) {
  const double c = 0.3;
  std::map<std::string, Value> attributes = law.attributes;
  attributes["inversion"] = std::string("clamped");
  const auto clamped = law_of(law.tag, attributes);
  const Mat3 d = random.matrix(), e = random.matrix();
  std::array<Series, 9> numbers;
  for (int k = 0; k < 9; ++k)
    numbers[static_cast<std::size_t>(k)] =
        Series(F(k / 3, k % 3)) + d(k / 3, k % 3) * Series::step(0) + e(k / 3, k % 3) * Series::step(1);
  const double nu = clamped->poisson_ratio(), stiffness = 2 * clamped->shear_modulus() * (1 - nu) / (1 - 2 * nu);
  const Series expected = continued(law.energy, stretches(numbers), c, stiffness),
               rest = law.energy({Series(1), Series(1), Series(1)});
  const Point point = evaluate(*clamped, F);
  double curvature = 0;
  for (int i = 0; i < 9; ++i)
    for (int k = 0; k < 9; ++k) curvature += d(i / 3, i % 3) * point.tangent(i, k) * e(k / 3, k % 3);
  const double size = 1e-10 * point.tangent.norm();
  EXPECT_NEAR(point.energy, expected.c[0] - rest.c[0], size) << law.tag << "\n" << F;
  EXPECT_NEAR(point.P.cwiseProduct(d).sum(), expected.c[1], size) << law.tag << "\n" << F;
  EXPECT_NEAR(curvature, expected.c[3], size * d.norm() * e.norm()) << law.tag << "\n" << F;
}

// One, two and three stretches below the bound of 0.3, inverted or not; 0.05 away from places where the two smallest
// add up to 0, 0.01 from the bound, where the tangent jumps, and 0.05 from equal stretches, where the cubic has double
// roots.
TEST(Clamped, StressAndTangentOfEveryIsotropicLawAreExactDerivativesThroughInversion) {
  std::vector<Case> laws = of_hookes_constants();
  for (const char* measure : {"lnJ2", "J1", "I3"})
    for (Case& law : of_isochoric_invariants(measure)) laws.push_back(std::move(law));
  EXPECT_EQ(laws.size(), 19);
  Random random;
  for (const Case& law : laws)
    for (const Vec3& s : {Vec3(2.2, 1.3, 0.1), Vec3(1.4, 0.8, -0.4), Vec3(1.2, 0.05, -0.6), Vec3(0.1, 0.7, -1.3),
                          Vec3(0.28, 0.1, 0.04), Vec3(0.05, 0.1, -0.29)})
      compare(law, random.stretched(s[0], s[1], s[2]), random);
}

}  // namespace
}  // namespace msml::fe
