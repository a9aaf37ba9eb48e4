// SPDX-License-Identifier: GPL-3.0-or-later
// Static equilibrium: loads grow from what the step before left to what this step asks for.
#include <algorithm>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// The load path of one step: loads and supports at a share in (0, 1].
struct Path {
  const LoadSet* before;  ///< null in the first step
  const LoadSet* goal;
  Supports supports;
  double start, duration;
  double time(double share) const { return start + share * duration; }
  ScaledLoads loads(double share) const {
    ScaledLoads loads{{goal, share, time(share)}};
    if (before && share < 1) loads.push_back({before, 1 - share, start});
    return loads;
  }
};

/// Goes from one share to another, in halved pieces where Newton's method fails; at most 2^6 pieces.
/// Returns the result that failed last, or a converged one.
IncrementResult advance(Run& run, const Path& path, double from, double to) {
  double piece = to - from;
  const double smallest = piece / 64;
  IncrementResult result;
  while (from < to) {
    const double share = std::min(to, from + piece) > to - 1e-12 ? to : from + piece;
    Increment increment{
        run.now.u, path.supports.fixed, path.supports.at(share, path.time(share)), path.loads(share), {}, nullptr};
    run.newton.prepare(run.now.u, increment.loads);
    result = run.newton.run(increment);
    if (result.stop == Stop::converged) {
      run.now.u = result.u;
      from = share;
      piece = std::min(piece * 2, to - from);
      continue;
    }
    const bool hopeless = result.stop == Stop::singular || result.stop == Stop::out_of_memory;
    if (hopeless || run.model.settings.newton_iterations == 1 || piece / 2 < smallest) {
      explain(run, result, share);
      return result;
    }
    piece /= 2;
  }
  return result;
}

}  // namespace

void run_static(Run& run) {
  const Model& model = run.model;
  const int parts = model.settings.load_steps;
  run.newton.prepare(run.now.u, {});
  run.newton.rest();
  if (!run.accept()) return;
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    run.now.step = static_cast<int>(s);
    const Path path{s > 0 ? &run.equations.loads(static_cast<int>(s) - 1) : nullptr,
                    &run.equations.loads(static_cast<int>(s)),
                    make_supports(step, run.equations.numbering(), run.now.u), run.now.time, step.dt * step.count};
    for (int part = 1; part <= parts; ++part) {
      const double from = (part - 1.0) / parts, to = static_cast<double>(part) / parts;
      const Vector last_good = run.now.u;
      if (advance(run, path, from, to).stop != Stop::converged) {
        run.now.u = last_good;
        return;
      }
      run.newton.prepare(run.now.u, path.loads(to));
      run.newton.rest();
      run.now.time = path.time(to);
      ++run.now.increment;
      run.set_reactions(path.supports.fixed);
      if (!run.accept()) return;
    }
  }
}

}  // namespace msml::fe
