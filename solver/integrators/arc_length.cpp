// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria past limit points: the load factor is an unknown, the length of the displacement increment is given.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msml/core/error.hpp"
#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

constexpr int good_iterations = 5, most_cuts = 12;

/// Unknowns that are displacements (or values); pressures come after them.
Eigen::Index moving(const Run& run) { return 3 * static_cast<Eigen::Index>(run.equations.numbering().body_nodes()); }

double largest_displacement(const Run& run, const Vector& u) {
  double largest = 0;
  for (Eigen::Index k = 0; k < moving(run); k += 3) largest = std::max(largest, u.segment<3>(k).norm());
  return largest;
}

/// Crisfield's method (1981, doi 10.1016/0045-7949(81)90108-5) in its cylindrical form: |du| = length over each step,
/// load factor free. The linear systems are indefinite past a limit point. Lengths are those of displacements: the
/// pressures of mixed elements follow.
struct Arc {
  Run& run;
  const EquilibriumPath& path;
  std::unique_ptr<LinearSystem> linear;
  BlockMatrix matrix;
  Vector last = {};  ///< displacement increment of the step before; empty at first
  double length = 0, longest = 0;

  double along(const Vector& a, const Vector& b) const { return a.head(moving(run)).dot(b.head(moving(run))); }

  /// The length that leads to the bounds of the load and of the displacement, as far as the tangent foresees them.
  double reach(double lambda, double per_length, const Vector& t) const {
    const ArcLength& bounds = run.model.settings.arc_length;
    const double load = (bounds.load - (per_length > 0 ? lambda : -lambda)) / std::abs(per_length);
    double length_to = load > 0 ? 1.0001 * load : std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < moving(run) && std::isfinite(bounds.displacement); k += 3) {
      const Vec3 u = run.now.u.segment<3>(k), d = per_length * t.segment<3>(k);
      const double a = d.squaredNorm(), b = u.dot(d), c = u.squaredNorm() - bounds.displacement * bounds.displacement;
      if (a > 0 && c < 0) length_to = std::min(length_to, 1.0001 * (std::sqrt(b * b - a * c) - b) / a);
    }
    return length_to;
  }

  /// The share of a step to (u, lambda) after which it is at a bound; 1 where it does not pass one by more than 1e-3.
  double share_within(const Vector& u, double lambda) const {
    const ArcLength& bounds = run.model.settings.arc_length;
    double share = 1;
    const auto look = [&](double from, double to, double bound) {
      if (to > 1.001 * bound && from < bound) share = std::min(share, std::max(0.05, (bound - from) / (to - from)));
    };
    look(std::abs(run.now.load_factor), std::abs(lambda), bounds.load);
    look(largest_displacement(run, run.now.u), largest_displacement(run, u), bounds.displacement);
    return share;
  }

  /// Load per factor at u.
  Vector reference(const Vector& u) const {
    Forces all, none;
    run.equations.evaluate_loads(u, path.loads(1), all, nullptr);
    run.equations.evaluate_loads(u, path.loads(0), none, nullptr);
    Vector f = all.external - none.external;
    clear(f);
    return f;
  }

  void clear(Vector& v) const {
    for (std::size_t k = 0; k < path.supports.fixed.size(); ++k)
      if (path.supports.fixed[k]) v[static_cast<Eigen::Index>(k)] = 0;
  }

  LinearStatus factor() {
    matrix.values = run.newton.tangent().values;
    if (run.newton.followers()) add(matrix, 1, *run.newton.followers());
    return linear->factor(matrix, path.supports.fixed);
  }

  /// du_t = K^-1 f, and du_r = K^-1 r.
  bool directions(const Vector& u, const Vector& residual, Vector& by_load, Vector& by_residual) {
    if (factor() != LinearStatus::done) return false;
    const double tolerance = run.model.settings.linear_tolerance;
    run.newton.count(1, 2);
    const bool loaded = linear->solve(reference(u), tolerance, by_load) == LinearStatus::done;
    if (residual.size() == 0) return loaded;
    return loaded && linear->solve(residual, tolerance, by_residual) == LinearStatus::done;
  }

  /// The change of the load factor that keeps |way + r + x t| = length, in the direction of the way; NaN if none does.
  double keep_length(const Vector& way, const Vector& t, const Vector& r) const {
    const Vector base = way + r;
    const double a = along(t, t), b = along(t, base), c = along(base, base) - length * length, square = b * b - a * c;
    if (!(square >= 0) || !(a > 0)) return std::nan("");
    const double root = std::sqrt(square), one = (-b + root) / a, two = (-b - root) / a, forwards = along(way, t);
    return one * forwards >= two * forwards ? one : two;
  }

  /// Newton's criteria of increment and energy (see Newton), of the correction that the last matrix and its t foresee.
  bool complete(const Vector& way, const Vector& residual, const Vector& t, IncrementResult& result) const {
    const double tolerance = run.model.settings.tolerance;
    if (is_round_off(residual, matrix, path.supports.fixed, run.newton.finest(result.u))) return true;
    Vector r;
    run.newton.count(0, 1);
    if (linear->solve(residual, 0.1, r) != LinearStatus::done) return false;
    const double change = keep_length(way, t, r);
    if (!std::isfinite(change)) return false;
    const Vector missing = r + change * t;
    const Forces& forces = run.newton.forces();
    const double energy = std::max(
        {std::abs(forces.found.energy), std::abs(dot(forces.internal, way)), std::abs(dot(forces.external, way))});
    const Eigen::Index body = moving(run);
    result.missing_way = missing.head(body).cwiseAbs().maxCoeff() / result.u.head(body).cwiseAbs().maxCoeff();
    result.missing_energy = std::sqrt(std::abs(dot(residual, missing)) / energy);
    return result.missing_way <= tolerance && result.missing_energy <= tolerance;
  }

  /// One step from the present state; the result's u is the new displacement, `factor_out` its load factor.
  IncrementResult step(double& factor_out) {
    IncrementResult result;
    result.u = run.now.u;
    double lambda = run.now.load_factor;
    run.newton.prepare(result.u, path.loads(lambda));
    Vector t, r;
    if (!directions(result.u, {}, t, r)) return result.stop = Stop::singular, result;
    const double size = std::sqrt(along(t, t));
    const double sign = last.size() > 0 && along(last, t) < 0 ? -1 : 1;
    if (!(size > 0)) return result.stop = Stop::singular, result;
    if (length == 0) length = size / run.model.settings.load_steps, longest = 10 * length;
    length = std::min({length, longest, reach(lambda, sign / size, t)});
    lambda += sign * length / size;
    Vector way = sign * length / size * t;
    for (int iteration = 0; iteration < run.model.settings.newton_iterations; ++iteration) {
      result.u = run.now.u + way;
      run.newton.prepare(result.u, path.loads(lambda));
      run.newton.rest();
      const Forces& forces = run.newton.forces();
      Vector residual = forces.residual();
      clear(residual);
      const double norm = residual.norm();
      result.residuals.push_back(norm);
      result.scale = std::max(forces.external.norm(), forces.internal.norm());
      result.worst_element = forces.found.smallest_J_element;
      result.worst_J = forces.found.smallest_J;
      result.stop = run.newton.state_verdict();
      if (result.stop != Stop::converged || !std::isfinite(norm)) return result;
      const bool small = norm <= run.model.settings.tolerance * result.scale;
      if (small && complete(way, residual, t, result)) return factor_out = lambda, result;
      if (!directions(result.u, residual, t, r)) return result.stop = Stop::singular, result;
      const double change = keep_length(way, t, r);
      if (!std::isfinite(change)) break;
      lambda += change;
      way += r + change * t;
    }
    result.stop = Stop::newton_limit;
    return result;
  }
};

void check_supports(const Run& run, const EquilibriumPath& path, const Step& step) {
  const Vector target = path.supports.at(1, path.time(1));
  for (std::size_t k = 0; k < path.supports.fixed.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (path.supports.fixed[k] && std::abs(target[i] - run.now.u[i]) > 1e-14)
      throw Error(
          fmt::format("step '{}' moves supports, but arcLength follows loads alone: let the supports stay, or "
                      "take arcLength=\"false\" and prescribe the displacement",
                      step.name));
  }
}

void check_loads(const Arc& arc, const Step& step) {
  if (arc.reference(arc.run.now.u).squaredNorm() > 0) return;
  throw Error(fmt::format(
      "step '{}' has no load when it starts, at t = {:g}: arcLength scales the loads that act there. Give one, "
      "without a table or a function of t that is 0 then, or take arcLength=\"false\"",
      step.name, arc.path.start));
}

bool enough(const Run& run, int taken) {
  const ArcLength& arc = run.model.settings.arc_length;
  return taken >= arc.steps || std::abs(run.now.load_factor) >= arc.load ||
         largest_displacement(run, run.now.u) >= arc.displacement;
}

/// Equilibrium at the start of a step, before its loads grow: springs act in full from then on, and an initial
/// displacement is where the way to it begins. False if there is none: the outcome is explained then.
bool settle(Run& run, const EquilibriumPath& path) {
  const Step& step = run.model.steps[static_cast<std::size_t>(run.now.step)];
  const bool first = run.now.step == 0;
  const bool sprung =
      !step.springs.empty() || (!first && !run.model.steps[static_cast<std::size_t>(run.now.step) - 1].springs.empty());
  if (!sprung && (!first || run.now.u.isZero(0))) return true;
  const Increment increment{
      run.now.u, path.supports.fixed,  path.supports.at(1, path.time(1)), path.loads(0), {}, nullptr,
      {},        &path.supports.slides};
  const IncrementResult result = run.reach(increment);
  if (result.stop != Stop::converged) return explain(run, result, 0), false;
  const Vector before = run.now.u;
  run.now.u = result.u;
  run.newton.prepare(run.now.u, path.loads(0));
  run.newton.rest();
  run.set_reactions(run.newton.forces().residual(), path.supports);
  run.account(before);
  return true;
}

/// Takes the next step along the arc, shorter where it fails.
bool advance(Arc& arc) {
  Run& run = arc.run;
  IncrementResult result;
  double lambda = 0;
  for (int cut = 0; cut < most_cuts; ++cut) {
    result = arc.step(lambda);
    const double share = result.stop == Stop::converged ? arc.share_within(result.u, lambda) : 0.5;
    if (share == 1) break;
    arc.length *= share;
  }
  if (result.stop != Stop::converged) {
    run.newton.prepare(run.now.u, arc.path.loads(run.now.load_factor));
    run.newton.rest();
    return explain(run, result, run.now.load_factor), false;
  }
  const Vector before = run.now.u;
  const double change = lambda - run.now.load_factor;
  run.now.u = result.u;
  run.now.load_factor = lambda;
  const double steps = run.model.settings.arc_length.steps;
  run.now.time += arc.path.duration / steps;
  ++run.now.increment;
  run.set_reactions(run.newton.forces().residual(), arc.path.supports);
  run.account(before);
  const Vector moved = result.u - before;
  if (run.now.increment > 1 && change * run.piece < 0)
    run.outcome.notes.push_back(fmt::format("the load factor turns near {:.6g}, before increment {}: a limit point",
                                            lambda - change, run.now.increment));
  run.piece = change;
  arc.last = moved;
  const double iterations = static_cast<double>(result.residuals.size());
  arc.length *= std::clamp(std::sqrt(good_iterations / iterations), 0.5, 1.5);
  return true;
}

}  // namespace

void run_arc_length(Run& run) {
  const Model& model = run.model;
  for (const Step& step : model.steps) check_held(model, step);
  run.newton.prepare(run.now.u, {});
  run.newton.rest();
  run.now.load_factor = 0;
  run.mark();
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    EquilibriumPath path = begin_path(run, static_cast<int>(s));
    const LoadSet* goal = &run.equations.loads(run.now.step);
    const LoadSet* before = s > 0 ? &run.equations.loads(run.now.step - 1) : nullptr;
    const double held = s > 0 ? run.now.load_factor : 0;
    path.loads = [&, held](double share) {
      ScaledLoads loads{{goal, share, path.start}};
      if (before) loads.push_back({before, (1 - share) * held, path.start, true});
      return loads;
    };
    check_supports(run, path, step);
    run.now.load_factor = 0;
    const bool settled = settle(run, path);
    if ((s == 0 && !run.accept()) || !settled) return;  // the first state is the one that the loads find
    Arc arc{run, path,
            run.equations.has_followers() ? make_unsymmetric(model.settings.threads)
                                          : make_indefinite(model.settings.threads),
            BlockMatrix(run.newton.tangent().pattern)};
    check_loads(arc, step);
    for (int taken = 0; !enough(run, taken); ++taken)
      if (!advance(arc) || !run.accept()) return;
  }
}

}  // namespace msml::fe
