// SPDX-License-Identifier: GPL-3.0-or-later
// Slopes, fronts, crossings and tables.
#include "msml/study/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "msml/core/error.hpp"
#include "msml/study/extrapolate.hpp"

namespace msml {
namespace {

TEST(FittedSlope, OfAPowerIsItsExponent) {
  const auto fit = fitted_slope({{1, 3, 0}, {2, 12, 1}, {4, 48, 2}, {10, 300, 3}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->slope, 2, 1e-12);
  EXPECT_NEAR(fit->half_width, 0, 1e-6);  // the square root of round-off
}

TEST(FittedSlope, HasTheConfidenceOfTheTextbook) {
  // log y = 1, 3, 2 at log x = 0, 1, 2: slope 1/2, residuals -1/2, 1, -1/2, so s^2 = 1.5, and t(1) = 12.706.
  const double e = std::exp(1.0);
  const auto fit = fitted_slope({{1, e, 0}, {e, e * e * e, 1}, {e * e, e * e, 2}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->slope, 0.5, 1e-12);
  EXPECT_NEAR(fit->half_width, 12.706 * std::sqrt(1.5 / 2), 1e-9);
}

TEST(FittedSlope, NeedsTwoPlaces) {
  EXPECT_FALSE(fitted_slope({{1, 3, 0}}));
  EXPECT_FALSE(fitted_slope({{2, 3, 0}, {2, 4, 1}}));
}

TEST(ParetoFront, KeepsWhatNothingBeats) {
  const auto front = pareto_front({{3, 1, 0}, {1, 5, 1}, {2, 6, 2}, {4, 1, 3}, {2, 3, 4}});
  ASSERT_EQ(front.size(), 3U);
  EXPECT_EQ(front[0].row, 1U);
  EXPECT_EQ(front[1].row, 4U);
  EXPECT_EQ(front[2].row, 0U);
}

TEST(Reaches, FindsTheCrossingOnTheStraightLineOfTheLogarithms) {
  const std::vector<Point> points{{10, 1, 0}, {1000, 1e-4, 1}};  // y = (x / 10)^-2
  ASSERT_TRUE(reaches(points, 0.01));
  EXPECT_NEAR(*reaches(points, 0.01), 100, 1e-9);
  EXPECT_FALSE(reaches(points, 1e-5)) << "never reached";
  EXPECT_FALSE(reaches(points, 2)) << "below from the start";
}

TEST(Richardson, FindsTheLimitAndTheOrder) {
  // f = 3 + 2 h^1.7 at sizes that do not halve
  const std::array<double, 3> h{0.5, 0.3, 0.1};
  const auto limit =
      richardson(h, {3 + 2 * std::pow(0.5, 1.7), 3 + 2 * std::pow(0.3, 1.7), 3 + 2 * std::pow(0.1, 1.7)});
  ASSERT_TRUE(limit);
  EXPECT_NEAR(limit->value, 3, 1e-12);
  EXPECT_NEAR(limit->order, 1.7, 1e-10);
}

TEST(Richardson, HasNoLimitForValuesThatSwing) {
  EXPECT_FALSE(richardson({1, 0.5, 0.25}, {1, 2, 1.5}));
  EXPECT_FALSE(richardson({1, 0.5, 0.25}, {1, 2, 3})) << "steps that do not shrink";
}

TEST(Richardson, SaysWhyThereIsNoLimit) {
  EXPECT_EQ(why_no_limit({4, 2, 1}, {1.16, 1.04, 1.01}), "");
  EXPECT_NE(why_no_limit({4, 2, 1}, {1, 2, 1}).find("swing about"), std::string::npos);
  EXPECT_NE(why_no_limit({4, 2, 1}, {1, 2, 3}).find("do not come closer"), std::string::npos);
  EXPECT_NE(why_no_limit({4, 2, 1}, {1, 2, 2}).find("two that are equal"), std::string::npos);
  EXPECT_NE(why_no_limit({4, 4, 1}, {1, 2, 2}).find("from coarse to fine"), std::string::npos);
  EXPECT_NE(why_no_limit({4, 2, 1}, {1e9, 1, 0}).find("faster than any order"), std::string::npos);
}

TEST(Table, SurvivesItsCsv) {
  const Table table{{"a", "note"}, {{"1", "plain"}, {"2.5", "a \"word\", a comma\nand a line"}}};
  const Table again = parse_csv(to_csv(table), "t.csv");
  EXPECT_EQ(again.columns, table.columns);
  EXPECT_EQ(again.rows, table.rows);
  EXPECT_EQ(again.number(1, "a"), 2.5);
  EXPECT_TRUE(std::isnan(again.number(0, "note")));
}

TEST(Table, ARowOfAnotherLengthIsFound) {
  try {
    parse_csv("a,b\n1,2\n3\n", "t.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.str(), "t.csv:3: 1 values, but the first line names 2 columns");
  }
}

TEST(Curves, LeaveOutWhatDidNotEndWell) {
  const Table table{
      {"h", "kind", "error", "status"},
      {{"2", "a", "4", "done"}, {"1", "a", "1", "done"}, {"1", "b", "", "limit"}, {"1", "b", "3", "done"}}};
  const auto found = curves(table, "h", "error", {"kind"}, true);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].points[0].x, 1) << "in ascending order";
  EXPECT_EQ(found[1].points.size(), 1U);
}

}  // namespace
}  // namespace msml
