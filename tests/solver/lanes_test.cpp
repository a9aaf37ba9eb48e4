// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of eight numbers at once beside those of one.
#include "solver/materials/lanes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

/// Largest difference of f(x) from what `one` gives of the same number, in units of the last digit.
template <class Eight, class One>
double apart(const Lanes& x, const Eight& eight, const One& one) {
  const Lanes y = eight(x);
  double largest = 0;
  for (int i = 0; i < lanes; ++i) {
    const double right = one(x[i]);
    largest = std::max(largest, std::abs(y[i] - right) / (std::abs(right) * std::numeric_limits<double>::epsilon()));
  }
  return largest;
}

// ln(1 + x) and exp(x) - 1 keep their digits where x is tiny: energies of small strains are differences of them.
TEST(Lanes, HaveLogarithmsAndExponentialsOfSmallNumbers) {
  testing::Random random;
  for (int exponent = -60; exponent <= 3; ++exponent)
    for (int k = 0; k < 50; ++k) {
      Lanes x;
      for (int i = 0; i < lanes; ++i) x[i] = std::ldexp(random.number(1, 2), exponent);
      const Lanes below = -x / (1.0 + x);  // between -1 and 0
      for (const Lanes& at : {x, below}) {
        EXPECT_LT(apart(
                      at, [](Lanes v) { return ln1p(v); }, [](double v) { return std::log1p(v); }),
                  4)
            << exponent;
        EXPECT_LT(apart(
                      at, [](Lanes v) { return exp1m(v); }, [](double v) { return std::expm1(v); }),
                  4)
            << exponent;
      }
    }
}

TEST(Lanes, HaveNoLogarithmWhereAnElementIsInsideOut) {
  const Lanes x{-2, -1, 0, 1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 3, 4};
  const Lanes y = ln1p(x);
  EXPECT_TRUE(std::isnan(y[0]));
  EXPECT_EQ(y[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(y[2], 0);
  EXPECT_TRUE(std::isnan(y[4]));
  EXPECT_EQ(y[5], std::numeric_limits<double>::infinity());
}

TEST(Lanes, MakeADeformationGradient) {
  Tensor<Lanes> H;
  for (int k = 0; k < 9; ++k) H.c[k] = lanes_of(k);
  const Tensor<Lanes> F = deformation_gradient(H);
  for (int k = 0; k < 9; ++k) EXPECT_EQ(F.c[k][3], k % 4 == 0 ? k + 1 : k);
}

}  // namespace
}  // namespace msml::fe
