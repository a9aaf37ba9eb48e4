// SPDX-License-Identifier: GPL-3.0-or-later
// Settings that a scene refuses are told at once, before anything runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "msml/study/refusals.hpp"
#include "tests/commands/real_language.hpp"
#include "tests/study/bar.hpp"

namespace msml {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// What is told of the first study of the column.
Refusals refusals(const std::string& study) {
  std::vector<Fault> faults;
  const Document document = parse_document(studies::bar(study), "s.xml", faults);
  const Compilation compilation = compile(document, real_language());
  EXPECT_EQ(tiny::lines(compilation.faults), "");
  const Study& first = compilation.studies.at(0);
  return find_refusals(first, prepare_runs(document, real_language(), {}, first));
}

TEST(Refusals, AreNoneWhereEverySettingCanBeCompiled) {
  const Refusals found =
      refusals(R"(<study id="s"> <vary variable="E" values="10 20"/> <measure time="run"/></study>)");
  EXPECT_EQ(found.refused, 0U);
  EXPECT_EQ(found.all, 2U);
  EXPECT_EQ(found.told.message, "");
}

TEST(Refusals, AreListedTogetherWithTheirReasons) {
  const Refusals found = refusals(
      R"(<study id="s"> <vary variable="E" values="-5 10 0"/> <vary variable="n" values="1 2"/> <measure time="run"/></study>)");
  EXPECT_EQ(found.told.where.line, 17);
  EXPECT_EQ(found.told.message,
            "study 's': 4 of 6 settings are refused; they stand in the table all the same, with the reason\n"
            "  E=-5 n=1, E=-5 n=2: s.xml:10: youngModulus = -5 is not > 0 (from the variable at line 1)\n"
            "  E=0 n=1, E=0 n=2: s.xml:10: youngModulus = 0 is not > 0 (from the variable at line 1)");
  EXPECT_FALSE(found.hopeless());
}

TEST(Refusals, OfAllSettingsLeaveNothingToRun) {
  const Refusals found =
      refusals(R"(<study id="s"> <vary variable="E" values="-5 -6"/> <measure time="run"/></study>)");
  EXPECT_TRUE(found.hopeless());
  EXPECT_THAT(found.told.message,
              HasSubstr("no run of study 's' can be carried out: all of its 2 settings are refused\n  E=-5: s.xml:10"));
}

TEST(Refusals, OfAReferenceAreThoseOfItsRuns) {
  const Refusals found = refusals(
      R"(<study id="s"> <vary variable="n" values="1 2"/> <reference set="E=-1"/> <measure error="L2"/></study>)");
  EXPECT_TRUE(found.hopeless());
  EXPECT_THAT(found.told.message, HasSubstr("n=1, n=2: the reference: s.xml:10: youngModulus = -1 is not > 0"));
}

// A range that begins below zero: half of the samples, drawn before anything runs. Each has a reason of its own.
TEST(Refusals, OfSamplesAreFoundToo) {
  const auto start = std::chrono::steady_clock::now();
  const Refusals found = refusals(
      R"(<study id="s" combine="latinHypercube" samples="400"> <vary variable="E" from="-10" to="10"/> <measure time="run"/></study>)");
  EXPECT_EQ(found.all, 400U);
  EXPECT_EQ(found.refused, 200U);  // one sample in each of 400 equal parts
  EXPECT_THAT(found.told.message, HasSubstr("study 's': 200 of 400 settings are refused"));
  EXPECT_THAT(found.told.message, HasSubstr("\n  and 180 more reasons; msml study --dry-run lists all settings"));
  EXPECT_EQ(std::ranges::count(found.told.message, '\n'), 21);
  // About a millisecond each; a machine that does much else is given ten.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 4);
}

}  // namespace
}  // namespace msml
