// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions: values, facts, faults.
#include "msml/core/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace msml {
namespace {

Function of(const std::string& text, const Range& range = {}) {
  return Function(Formula(text), "force", range, {"s.xml", 4});
}

TEST(Formula, HasTheValueOfItsExpression) {
  const Eigen::Vector3d X(0.5, -2, 3);
  EXPECT_DOUBLE_EQ(of("X*Y + Z^2 - t")(X, 0.25), 0.5 * -2 + 9 - 0.25);
  EXPECT_DOUBLE_EQ(of("sin(pi*X) + ln(e)")(X, 0), 2);
  EXPECT_DOUBLE_EQ(of("-Z^2")(X, 0), -9);
  EXPECT_DOUBLE_EQ(of("2^3^2 + 0*X")(X, 0), 512);
  EXPECT_DOUBLE_EQ(of("t < 1 ? 5 : 7")(X, 1), 7);
  EXPECT_EQ(Function(3.5)(X, 1), 3.5);
}

TEST(Formula, KnowsWhatItDependsOn) {
  EXPECT_TRUE(of("t").of_time());
  EXPECT_FALSE(of("t").of_position());
  EXPECT_TRUE(of("Y + 1").of_position());
  EXPECT_FALSE(of("Y + 1").of_time());
  EXPECT_TRUE(Function(2).constant());
  const FormulaFacts facts = examine("3*pi");
  EXPECT_FALSE(facts.of_position || facts.of_time);
  EXPECT_DOUBLE_EQ(facts.value, 3 * 3.14159265358979323846);
}

TEST(Formula, ValueThatIsNotFiniteIsAnError) {
  try {
    of("1/X")({0, 1, 2}, 0.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "force = 1/X is inf at X = 0, Y = 1, Z = 2, t = 0.5, which is not finite");
    EXPECT_EQ(error.where().line, 4);
  }
}

TEST(Formula, ValueOutsideItsRangeIsAnError) {
  EXPECT_EQ(of("X", positive())({1, 0, 0}, 0), 1);
  EXPECT_THROW(of("X", positive())({-1, 0, 0}, 0), Error);
}

TEST(Formula, IsRefusedWhereItIsWrongEverywhere) {
  EXPECT_TRUE(never_allowed("1/(X-X)", {}).starts_with("is inf at X = "));
  EXPECT_TRUE(never_allowed("0*log(-1-t*t) + Y", {}).starts_with("is nan at X = "));
  EXPECT_NE(never_allowed("sqrt(-1 - X*X)", {}), "");
  EXPECT_NE(never_allowed("sqrt(-1 - t)", {}), "");  // time begins at 0
  EXPECT_NE(never_allowed("-1 - X*X", positive()), "");
  EXPECT_NE(never_allowed("2 + abs(Z)", half_open(0, 1)), "");
  EXPECT_TRUE(never_allowed("-1 - X*X", positive()).ends_with(", and > 0 at no place and time at all"));
}

// What suits at some place or time is left to the run, however narrow that is.
TEST(Formula, IsLeftToTheRunWhereItMaySuit) {
  EXPECT_EQ(never_allowed("-1 - X*X", {}), "");
  EXPECT_EQ(never_allowed("1/X", {}), "");
  EXPECT_EQ(never_allowed("sqrt(X - 10)*sqrt(11 - X)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(Y - 1000.25)*sqrt(1000.75 - Y)*sqrt(-Z - 40)*sqrt(41 + Z)", {}), "");
  EXPECT_EQ(never_allowed("t > 3.2 && t < 3.3 ? 1e-3 : -1", positive()), "");
  EXPECT_EQ(never_allowed("1e-12 - X^2 - Y^2 - Z^2", positive()), "");
  EXPECT_EQ(never_allowed("log(X - 123456)", {}), "");
  // Finite in a small ball or box far from the origin.
  EXPECT_EQ(never_allowed("sqrt(1-((X-37.3)^2+(Y-81.6)^2)/16)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(1-(X-105)^2-(Y-205)^2-(Z-305)^2)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(1-((X-120.5)/3)^2-((Y+45.25)/2.5)^2)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(1e-4-(X-.137)^2-(Y-.281)^2-(Z-1.42)^2)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(0.05^2-(X-.1)^2-(Y-.2)^2-(Z-.3)^2)", {}), "");
  EXPECT_EQ(never_allowed("sqrt(0.01-(3*X-75-2)^2)", {}), "");
  EXPECT_EQ(never_allowed("1000*((X-105)^2+(Y-205)^2<9)", positive()), "");
  EXPECT_NE(never_allowed("-1000*(1 + X*X)", positive()), "");
  EXPECT_EQ(never_allowed("X +", {}), "");  // its fault is told elsewhere
}

TEST(Formula, ThreadsDoNotDisturbEachOther) {
  const Function square = of("X*X + t");
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (int i = 0; i < 2000; ++i)
        wrong[static_cast<std::size_t>(k)] += square({1.0 * i, 0, 0}, k) != 1.0 * i * i + k;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, (std::vector<int>(4, 0)));
}

}  // namespace
}  // namespace msml
