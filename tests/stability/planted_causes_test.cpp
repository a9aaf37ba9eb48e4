// SPDX-License-Identifier: GPL-3.0-or-later
// 50 scenes with a known planted cause: each is named right, and its twin without the cause is solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "msml/core/error.hpp"
#include "tests/stability/planted.hpp"

namespace msml::fe {
namespace {

using namespace testing;

struct Ending {
  bool refused = false;
  Stop stop = Stop::converged;
  std::string said;
};

Ending ending(const Model& model) {
  try {
    const Outcome outcome = solve(model, {});
    EXPECT_TRUE(outcome.state.displacement.allFinite());
    std::string said = outcome.diagnosis;
    for (const std::string& recovery : outcome.recoveries) said += recovery;
    return {false, outcome.stop, said};
  } catch (const Error& error) {
    return {true, Stop::converged, error.what()};
  }
}

TEST(PlantedCauses, AreNamedRight) {
  std::map<std::string, int> named;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Planted scene = plant(seed, true);
    const Ending found = ending(scene.model);
    const bool ended =
        scene.stops.empty() ? found.refused : !found.refused && std::ranges::count(scene.stops, found.stop) == 1;
    const bool right = ended && found.said.find(scene.word) != std::string::npos;
    named[scene.cause] += right;
    EXPECT_TRUE(right) << seed << ", " << scene.cause << ": " << name(found.stop) << ": " << found.said;
  }
  for (const auto& [cause, count] : named) std::printf("%3d of 5 %s\n", count, cause.c_str());
}

// The words are no luck: without the cause they are not said.
TEST(PlantedCauses, AreNotNamedWhereTheyAreNotPlanted) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Planted twin = plant(seed, false);
    const Ending found = ending(twin.model);
    EXPECT_TRUE(!found.refused && found.stop == Stop::converged) << seed << ", " << twin.cause << ": " << found.said;
    EXPECT_EQ(found.said.find(twin.word), std::string::npos) << seed << ", " << twin.cause << ": " << found.said;
  }
}

}  // namespace
}  // namespace msml::fe
