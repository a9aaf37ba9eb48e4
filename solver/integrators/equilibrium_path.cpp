// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium along a path of loads, in pieces that halve where Newton's method fails.
#include <algorithm>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

IncrementResult try_piece(Run& run, const EquilibriumPath& path, double from, double share) {
  Increment increment{
      run.now.u, path.supports.fixed,  path.supports.at(share, path.time(share)), path.loads(share), {}, nullptr,
      {},        &path.supports.slides};
  run.equations.begin_step((share - from) * path.duration);
  if (run.equations.has_history()) run.newton.forget();
  return run.newton.run(increment);
}

void take(Run& run, const EquilibriumPath& path, double share, const Vector& u) {
  const Vector before = run.now.u;
  run.now.u = u;
  run.newton.prepare(u, path.loads(share));
  run.newton.rest();
  run.set_reactions(run.newton.forces().residual(), path.supports);
  run.account(before);
  run.equations.end_step(u);
}

}  // namespace

bool advance(Run& run, const EquilibriumPath& path, double from, double to) {
  const Motion before = run.now;
  const double smallest = (to - from) / 64;
  double piece = to - from;
  while (from < to) {
    const double share = std::min(to, from + piece) > to - 1e-12 ? to : from + piece;
    const IncrementResult result = try_piece(run, path, from, share);
    if (result.stop == Stop::converged) {
      take(run, path, share, result.u);
      from = share;
      piece = std::min(piece * 2, to - from);
      continue;
    }
    run.newton.forget();
    const bool hopeless = result.stop == Stop::singular || result.stop == Stop::out_of_memory;
    if (hopeless || run.model.settings.newton_iterations == 1 || piece / 2 < smallest) {
      run.now = before;
      explain(run, result, share);
      return false;
    }
    piece /= 2;
  }
  run.now.time = path.time(to);
  ++run.now.increment;
  return true;
}

}  // namespace msml::fe
