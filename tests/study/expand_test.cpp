// SPDX-License-Identifier: GPL-3.0-or-later
// From what varies to settings.
#include "msml/study/expand.hpp"

#include <gtest/gtest.h>

#include <set>

namespace msml {
namespace {

void no_fault(const Location&, const std::string& what) { ADD_FAILURE() << what; }

Vary list(std::vector<std::string> variables, const std::string& values) {
  Vary vary{.variables = std::move(variables), .values = {}, .where = {}};
  vary.values = parse_values(values, vary, no_fault);
  return vary;
}

Study of(std::vector<Vary> vary) {
  Study study{.id = "s", .title = "", .vary = std::move(vary), .truth = {}, .measures = {}, .charts = {}, .where = {}};
  return study;
}

TEST(Expand, AProductHasEveryPairAndTheLastChangesFastest) {
  const auto runs = expand(of({list({"a"}, "1 2"), list({"b"}, "x, y, z")}), no_fault);
  ASSERT_EQ(runs.size(), 6U);
  EXPECT_EQ(runs[1], (Settings{{"a", "1"}, {"b", "y"}}));
  EXPECT_EQ(runs[5], (Settings{{"a", "2"}, {"b", "z"}}));
}

TEST(Expand, ValuesBetweenSemicolonsMayHoldBlanks) {
  const auto runs = expand(of({list({"n"}, "1 2 7; 2 4 14;")}), no_fault);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1][0].second, "2 4 14");
}

TEST(Expand, BracesHoldTogetherWhatIsOneValue) {
  const auto runs = expand(of({list({"kind", "n"}, "tet4 {1 2 7}; tet10 {2, 4, 14}")}), no_fault);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1], (Settings{{"kind", "tet10"}, {"n", "{2, 4, 14}"}}));
  EXPECT_EQ(expand(of({list({"n"}, "{1 2 7} {2 4 14}")}), no_fault).size(), 2U);
}

TEST(Expand, VariablesThatVaryTogetherTakeTheirTuples) {
  const auto runs = expand(of({list({"n", "dt"}, "1 .1; 2 .05")}), no_fault);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1], (Settings{{"n", "2"}, {"dt", ".05"}}));
}

TEST(Expand, ZippedListsGoSideBySide) {
  Study study = of({list({"a"}, "1 2"), list({"b"}, "x y")});
  study.combine = Combine::zip;
  EXPECT_EQ(expand(study, no_fault), (std::vector<Settings>{{{"a", "1"}, {"b", "x"}}, {{"a", "2"}, {"b", "y"}}}));
}

TEST(Expand, ALatinHypercubeHasOneSampleInEachPartOfEachRange) {
  Vary linear{.variables = {"E"}, .values = {}, .from = 1000, .to = 3000, .ranged = true, .where = {}};
  Vary log{.variables = {"k"}, .values = {}, .from = 1, .to = 1000, .ranged = true, .log = true, .where = {}};
  Study study = of({linear, log});
  study.combine = Combine::latin_hypercube;
  study.samples = 50;
  const auto runs = expand(study, no_fault);
  ASSERT_EQ(runs.size(), 50U);
  std::set<int> parts, log_parts;
  for (const Settings& run : runs) {
    parts.insert(static_cast<int>((std::stod(run[0].second) - 1000) / 2000 * 50));
    log_parts.insert(static_cast<int>(std::log(std::stod(run[1].second)) / std::log(1000) * 50));
  }
  EXPECT_EQ(parts.size(), 50U);
  EXPECT_EQ(log_parts.size(), 50U);
  EXPECT_EQ(expand(study, no_fault), runs) << "the seed decides";
  study.seed = 2;
  EXPECT_NE(expand(study, no_fault), runs);
}

TEST(Expand, RoundedValuesAreNotRunTwice) {
  Vary vary{.variables = {"n"}, .values = {}, .from = 1, .to = 4, .ranged = true, .whole = true, .where = {}};
  EXPECT_EQ(range_values(vary, 10), (std::vector<std::vector<std::string>>{{"1"}, {"2"}, {"3"}, {"4"}}));
  Study study;
  study.combine = Combine::latin_hypercube;
  study.samples = 50;
  study.vary = {vary};
  EXPECT_EQ(expand(study, [](const Location&, const std::string&) {}).size(), 4U);
}

TEST(Expand, SettingsAreTakenApart) {
  EXPECT_EQ(parse_settings("a=1 b=x", {}, no_fault), (Settings{{"a", "1"}, {"b", "x"}}));
  EXPECT_EQ(parse_settings("a = 1 2; b=x", {}, no_fault), (Settings{{"a", "1 2"}, {"b", "x"}}));
}

}  // namespace
}  // namespace msml
