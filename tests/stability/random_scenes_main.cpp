// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the scenes of some seeds: random_scenes FIRST COUNT. One line for each as it ends: seed, seconds of the
// processor, how it ended, what is wrong with that ("" where nothing is), the words of the scene; tabs between them.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "msml/core/error.hpp"
#include "tests/stability/random_scenes.hpp"

namespace {

using namespace msml::fe;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What every ending has to hold to; "" if it does.
std::string wrong_with(const Model& model, const Outcome& outcome) {
  const bool well = outcome.stop == Stop::converged;
  const State& state = outcome.state;
  if (!state.displacement.allFinite() || !state.velocity.allFinite() || !state.reaction.allFinite())
    return "its last state is not finite";
  if (outcome.diagnosis.empty() != well) return "ended " + std::string(name(outcome.stop)) + ": " + outcome.diagnosis;
  if (outcome.diagnosis.find("nan") != std::string::npos) return outcome.diagnosis;
  if (outcome.stop == Stop::newton_limit || outcome.stop == Stop::diverged) return "no cause: " + outcome.diagnosis;
  // One linear solve per step leaves what it leaves; explicit methods solve nothing.
  if (well && model.settings.newton_iterations > 1 && !(outcome.check.residual <= 1e-6))
    return fmt::format("residual {:g}", outcome.check.residual);
  return {};
}

void run(unsigned seed) {
  const testing::Drawn drawn = testing::draw_scene(seed);
  const double begin = processor_seconds();
  std::string ended = "refused", wrong;
  try {
    const Outcome outcome = solve(drawn.model, {});
    ended = name(outcome.stop);
    wrong = wrong_with(drawn.model, outcome);
  } catch (const msml::Error& error) {
    wrong = error.what();  // nothing that is drawn is to be refused
  }
  std::printf("%u\t%.3f\t%s\t%s\t%s\n", seed, processor_seconds() - begin, ended.c_str(), wrong.c_str(),
              drawn.words.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto first = static_cast<unsigned>(std::atoi(argv[1])), count = static_cast<unsigned>(std::atoi(argv[2]));
  for (unsigned seed = first; seed < first + count; ++seed) run(seed);
  return 0;
}
