// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium along a path of loads, in pieces that halve where Newton's method fails.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

constexpr int most_singular = 2;  // adaptive pieces in a row: shorter ones may not meet what the way of a long one met

IncrementResult try_piece(Run& run, const EquilibriumPath& path, double from, double share, bool last_resort) {
  Increment increment{
      run.now.u, path.supports.fixed,  path.supports.at(share, path.time(share)), path.loads(share), {}, nullptr,
      {},        &path.supports.slides};
  run.check_balanced(increment.loads);
  run.equations.begin_step((share - from) * path.duration);
  if (run.equations.has_history()) run.newton.forget();
  return last_resort && !run.tangled ? run.newton.walk(increment) : run.reach(increment);
}

void take(Run& run, const EquilibriumPath& path, double share, const Vector& u) {
  const Vector before = run.now.u;
  run.now.u = u;
  run.now.time = path.time(share);
  run.now.load_factor = share;
  if (!run.free.modes.empty()) {
    Forces forces;
    run.equations.evaluate_loads(u, path.loads(share), forces, nullptr);
    remove_free_motions(run.free, run.equations.small_strain(), forces.external.norm(), run.equations.positions(),
                        run.now.u);
  }
  run.newton.prepare(run.now.u, path.loads(share));
  run.newton.rest();
  run.set_reactions(run.newton.forces().residual(), path.supports);
  run.equations.end_step(run.now.u);
  run.account(before);
}

/// Halves the way from the present equilibrium, at a share of the path, to one that fails, so that what is wrong there
/// shows: the present state becomes the last equilibrium that is found. Returns the smallest share that fails. Takes
/// about as many iterations as the run before, or a hundred.
double approach(Run& run, const EquilibriumPath& path, double from, double fails) {
  constexpr int halvings = 20;
  const int most = std::max(100, 2 * run.newton.iterations());
  for (int k = 0; k < halvings && run.newton.iterations() < most; ++k) {
    const double middle = 0.5 * (run.now.load_factor + fails);
    const IncrementResult result = try_piece(run, path, from, middle, false);
    if (result.stop == Stop::converged)
      run.now.u = result.u, run.now.load_factor = middle;
    else
      fails = middle;
  }
  return fails;
}

/// Adaptive pieces are no longer than half the shortest relaxation time, as a share of the path.
double longest_piece(const Run& run, const EquilibriumPath& path, double whole, double smallest) {
  double tau = std::numeric_limits<double>::infinity();
  for (const Region& region : run.model.regions)
    for (const double t : region.prony.tau) tau = std::min(tau, t);
  return std::clamp(0.5 * tau / path.duration, smallest, whole);
}

/// Few iterations: longer pieces; many: shorter ones.
double growth(const IncrementResult& result, bool adaptive) {
  const std::size_t iterations = result.residuals.size() - 1;
  if (!adaptive || iterations <= 4) return 2;
  return iterations <= 8 ? 1 : 0.6;
}

/// Why a piece failed that could not be halved any more; "" if that is not found.
std::string cause_of(Run& run, const EquilibriumPath& path, double from, double share, IncrementResult& result) {
  if (result.stop != Stop::newton_limit && result.stop != Stop::diverged) return "";
  const double fails = run.model.settings.newton_iterations > 1 ? approach(run, path, from, share) : share;
  if (std::string found = find_cause(run, path, fails, result); !found.empty()) return found;
  if (fails < share) return cause_of_iterations(run, result);
  result.stop = Stop::step_too_large;
  return fmt::format("in shorter pieces the way is found, to {:.6g} of the loads", run.now.load_factor);
}

}  // namespace

EquilibriumPath begin_path(Run& run, int step) {
  const Step& now = run.model.steps[static_cast<std::size_t>(step)];
  run.now.step = step;
  return {{}, make_supports(now, run.equations.numbering(), run.now.u), run.now.time, now.dt * now.count};
}

bool advance(Run& run, const EquilibriumPath& path, double from, double to) {
  const bool adaptive = run.model.settings.adaptive_step;
  const Step& step = run.model.steps[static_cast<std::size_t>(run.now.step)];
  const double smallest = (to - from) / (adaptive ? 4096 : 64);
  const double longest = adaptive ? longest_piece(run, path, to - from, smallest) : to - from;
  double piece = longest;
  if (adaptive && run.piece > 0) piece = std::clamp(run.piece / path.duration, smallest, piece);
  int singular = 0;
  while (from < to) {
    const double kink = adaptive ? path.share(next_stop(step, path.time(from), path.time(to))) : to;
    const double stop =
        kink < to - 1e-12 ? kink : to;  // round-off between shares and times would leave a rest for ever
    const double share = from + piece > stop - 1e-12 ? stop : from + piece;
    const bool last_resort = piece / 2 < smallest;
    IncrementResult result = try_piece(run, path, from, share, last_resort);
    if (result.stop == Stop::converged) {
      take(run, path, share, result.u);
      from = share;
      singular = 0;
      piece = std::min(longest, piece * growth(result, adaptive));
      if (adaptive) run.piece = piece * path.duration;
      continue;
    }
    run.newton.forget();
    singular = result.stop == Stop::singular ? singular + 1 : 0;
    const bool hopeless = result.stop == Stop::out_of_memory || singular > (adaptive ? most_singular : 0);
    if (hopeless || run.model.settings.newton_iterations == 1 || last_resort) {
      const Motion accepted = run.now;
      run.now.load_factor = from;
      const std::string evidence = cause_of(run, path, from, share, result);
      const auto [found, furthest] = std::pair(run.now.u, run.now.load_factor);
      run.now = accepted;
      if (furthest > from)
        run.equations.begin_step((furthest - from) * path.duration), take(run, path, furthest, found);
      explain(run, result, share, evidence);
      return false;
    }
    piece = (share - from) / 2;
    ++run.halved;
  }
  run.now.time = path.time(to);
  ++run.now.increment;
  return true;
}

}  // namespace msml::fe
