// SPDX-License-Identifier: GPL-3.0-or-later
// 500 scenes drawn at random: every one ends in equilibrium, or in a diagnosis from a closed list of causes, in time.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <sstream>

#include "tests/sanitized.hpp"
#include "tests/stability/child.hpp"

namespace msml::fe {
namespace {

constexpr double most_seconds = testing::sanitized ? 75 : 15;  ///< of the processor, for a scene

struct Tally {
  std::map<std::string, int> counts;  ///< by how they ended
  std::vector<std::string> faults;    ///< of single scenes
  double longest = 0;
};

void count_line(const std::string& line, Tally& tally) {
  std::istringstream parts(line);
  std::string seed, seconds, ended, wrong, words;
  for (std::string* part : {&seed, &seconds, &ended, &wrong, &words}) std::getline(parts, *part, '\t');
  ++tally.counts[ended];
  tally.longest = std::max(tally.longest, std::stod(seconds));
  if (!wrong.empty()) tally.faults.push_back(words + ": " + wrong);
  if (std::stod(seconds) > most_seconds) tally.faults.push_back(words + ": took " + seconds + " s");
}

/// Runs scenes in a program of their own, one after another. One that says nothing for `patience` seconds is ended and
/// is a fault, as one that takes the program down with it; the next ones run in a new program.
Tally run_scenes(const std::vector<std::string>& program, unsigned first, unsigned count, double patience) {
  Tally tally;
  unsigned seed = first;
  while (seed < first + count) {
    std::vector<std::string> words = program;
    words.insert(words.end(), {std::to_string(seed), std::to_string(first + count - seed)});
    testing::Child child(words);
    std::string line;
    testing::Child::Told told = testing::Child::Told::line;
    for (; seed < first + count; ++seed) {
      told = child.next(patience, line);
      if (told != testing::Child::Told::line) break;
      count_line(line, tally);
    }
    if (told == testing::Child::Told::line) break;
    const bool hung = told == testing::Child::Told::nothing;
    ++tally.counts[hung ? "hung" : "crashed"];
    tally.faults.push_back("seed " + std::to_string(seed++) + (hung ? " was ended: it hung" : " crashed"));
  }
  return tally;
}

// In four parts, so that they can run side by side.
class RandomScenes : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomScenes, EndInEquilibriumOrInADiagnosis) {
  // By the clock, which others that share the machine lengthen.
  const Tally tally = run_scenes({RANDOM_SCENES}, GetParam() + 1, 125, 100);
  for (const auto& [cause, count] : tally.counts) std::printf("%4d %s\n", count, cause.c_str());
  std::printf("%4zu of these at fault; longest %.2f s\n", tally.faults.size(), tally.longest);
  for (const std::string& fault : tally.faults) ADD_FAILURE() << fault;
  int all = 0;
  for (const auto& [cause, count] : tally.counts) all += count;
  EXPECT_EQ(all, 125);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenes, ::testing::Values(0U, 125U, 250U, 375U));

// The third of five scenes never ends, the fourth takes its program down: both are faults, the others count.
TEST(RandomScenesRun, AHangAndACrashAreEndedAndCounted) {
  const std::string script =
      "i=$0; while [ $i -lt $(($0+$1)) ]; do [ $i = 3 ] && exec sleep 1000; [ $i = 4 ] && exit 1; "
      "printf '%s\\t0.1\\tconverged\\t\\tscene\\n' $i; i=$(($i+1)); done";
  const Tally tally = run_scenes({"sh", "-c", script}, 1, 5, 0.5);
  EXPECT_EQ(tally.counts, (std::map<std::string, int>{{"converged", 3}, {"hung", 1}, {"crashed", 1}}));
  EXPECT_EQ(tally.faults, (std::vector<std::string>{"seed 3 was ended: it hung", "seed 4 crashed"}));
}

}  // namespace
}  // namespace msml::fe
