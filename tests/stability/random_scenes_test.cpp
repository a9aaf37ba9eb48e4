// SPDX-License-Identifier: GPL-3.0-or-later
// 500 scenes drawn at random: every one ends in equilibrium, or in a diagnosis from a closed list of causes.
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>
#include <map>

#include "msml/core/error.hpp"
#include "tests/stability/random_scenes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// Seconds of this process, which others that share the machine do not lengthen.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Tally {
  std::map<std::string, int> counts;
  int without_cause = 0;  ///< ended without equilibrium and without a word on what is behind it
  double longest = 0;
};

/// What every ending has to hold to.
void check_ending(const Model& model, const Outcome& outcome) {
  const bool well = outcome.stop == Stop::converged;
  EXPECT_TRUE(outcome.state.displacement.allFinite());
  EXPECT_TRUE(outcome.state.velocity.allFinite());
  EXPECT_TRUE(outcome.state.reaction.allFinite());
  EXPECT_EQ(outcome.diagnosis.empty(), well);
  EXPECT_EQ(outcome.diagnosis.find("nan"), std::string::npos) << outcome.diagnosis;
  // One linear solve per step leaves what it leaves; explicit methods solve nothing.
  if (well && model.settings.newton_iterations > 1) {
    EXPECT_LE(outcome.check.residual, 1e-6);
  }
}

void run_scene(unsigned seed, Tally& tally) {
  const Drawn drawn = draw_scene(seed);
  SCOPED_TRACE(drawn.words);
  const double begin = processor_seconds();
  try {
    const Outcome outcome = solve(drawn.model, {});
    ++tally.counts[name(outcome.stop)];
    tally.without_cause += outcome.stop == Stop::newton_limit || outcome.stop == Stop::diverged;
    check_ending(drawn.model, outcome);
  } catch (const Error& error) {
    ++tally.counts["refused"];
    ADD_FAILURE() << error.what();  // nothing that is drawn is to be refused
  }
  const double seconds = processor_seconds() - begin;
  EXPECT_LT(seconds, 15);
  tally.longest = std::max(tally.longest, seconds);
}

// In four parts, so that they can run side by side.
class RandomScenes : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomScenes, EndInEquilibriumOrInADiagnosis) {
  Tally tally;
  for (unsigned seed = GetParam() + 1; seed <= GetParam() + 125; ++seed) run_scene(seed, tally);
  for (const auto& [cause, count] : tally.counts) std::printf("%4d %s\n", count, cause.c_str());
  std::printf("%4d of these without a cause; longest %.2f s\n", tally.without_cause, tally.longest);
  EXPECT_EQ(tally.without_cause, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenes, ::testing::Values(0U, 125U, 250U, 375U));

}  // namespace
}  // namespace msml::fe
