// SPDX-License-Identifier: GPL-3.0-or-later
// Forward Euler, symplectic Euler and central differences: no equations to solve, but a largest stable time step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/integrators/stepper.hpp"
#include "solver/stable_step.hpp"

namespace msml::fe {
namespace {

constexpr double most_growth = 2;  // of an undamped motion over the rest of a run
constexpr double odd = 1;          // times the energy that was put in: more is no motion of the body any more
constexpr double absurd = 1e6;     // and this says that it does not come back
constexpr int watch_every = 100;   // time steps between estimates of the stable one, where the stiffness may change

/// What damping sees in a time step.
struct Braking {
  Vector velocity, led;  ///< for alpha M before the step's acceleration, and for the damping beside it
  double implicit = 0;   ///< how much of the acceleration the velocity for alpha M still takes up
};

struct Explicit {
  Run& run;
  BlockMatrix C;                    ///< damping beside alpha M
  bool damped = false;              ///< there is such damping
  bool warned = false;              ///< of motions that grow
  double put_in = 0;                ///< largest energy that start and loads have given, while the motion was sane
  std::optional<Motion> sane = {};  ///< the last state before the energy grew beyond that, while it is beyond

  /// M a = external - internal - damping at free unknowns; `a` of fixed ones is given. alpha M brakes the velocity with
  /// its share of that acceleration: a diagonal equation.
  void balance(const Vector& u, Braking braking, const ScaledLoads& loads, const Supports& supports, Vector& a) {
    run.newton.look(u, loads);
    run.newton.move(braking.velocity, Vector::Zero(u.size()), damped ? &C : nullptr, &braking.led);
    Vector force = run.newton.forces().residual() / (1 + run.model.settings.damping_mass * braking.implicit);
    supports.slides.project(force);
    const ScalarMatrix& mass = run.equations.mass();
    for (Eigen::Index k = 0; k < a.size(); ++k)
      if (!supports.fixed[static_cast<std::size_t>(k)]) {
        a[k] =
            force[k] / mass.values[static_cast<std::size_t>(mass.pattern->diagonal[static_cast<std::size_t>(k / 3)])];
        braking.velocity[k] += braking.implicit * a[k];
      }
    run.newton.move(braking.velocity, a, damped ? &C : nullptr, &braking.led);
  }

  /// Dampers are no multiple of M and K, but no motion is damped more than the one with the largest eigenvalue of C.
  /// For forward Euler, which lives on damping, they count where the motion is small enough to be seen whole.
  double limit_of(const BlockMatrix& K, double largest, const Mask& fixed) const {
    const Settings& s = run.model.settings;
    if (run.equations.has_dampers() && s.integrator == Integrator::forward_euler && s.damping_mass == 0)
      if (const auto limit = forward_euler_step(K, C, run.equations.mass(), fixed)) return *limit;
    if (!run.equations.has_dampers() || s.integrator == Integrator::forward_euler)
      return stable_step(s.integrator, largest, s.damping_mass, s.damping_stiffness * largest);
    return stable_step(s.integrator, largest, s.damping_mass, largest_eigenvalue(C, run.equations.mass(), fixed));
  }

  /// Forward Euler lets every motion grow that nothing damps, such as a pendulum's swing beside a damped spring: that
  /// does no harm where it is little in the steps that are left.
  bool grows_little(const BlockMatrix& K, const Mask& fixed, double dt, int left) {
    if (run.model.settings.integrator != Integrator::forward_euler || !run.equations.has_dampers()) return false;
    const auto growth = forward_euler_growth(K, C, run.equations.mass(), fixed, dt);
    const double factor = growth ? std::pow(*growth, left) : std::numeric_limits<double>::infinity();
    if (!(factor <= most_growth)) return false;
    if (!warned)
      run.outcome.warnings.push_back(
          fmt::format("forwardEuler: a motion that nothing damps grows, by up to {:.3g} to the end of the step; take "
                      "a smaller dt or symplecticEuler",
                      factor));
    return warned = true;
  }

  /// False if dt is too large for the present stiffness and the scene does not allow that. `left`: steps to come, of a
  /// run that is under way; 0 before it.
  bool stable(const Step& step, const Mask& fixed, const ScaledLoads& loads, int left) {
    const Settings& settings = run.model.settings;
    if (settings.allow_unstable) return true;
    BlockMatrix K(C.pattern);
    run.newton.stiffness(run.now.u, loads, K);
    if (run.equations.has_dampers()) run.newton.damping(run.now.u, loads, C);
    const double largest = largest_eigenvalue(K, run.equations.mass(), fixed);
    if (!std::isfinite(largest)) return left > 0 || run.now.increment == 0 || blown_up(step);
    const double limit = limit_of(K, largest, fixed);
    run.outcome.stable_step = std::min(run.outcome.stable_step, limit);
    if (step.dt <= limit * (1 + 1e-6) || (left > 0 && grows_little(K, fixed, step.dt, left))) return true;
    refuse(step, limit, std::sqrt(largest));
    return false;
  }

  /// A state that once was sound has grown until its stiffness is beyond numbers, or its energy absurd. Always false:
  /// that is too large a step.
  bool blown_up(const Step& step, const std::string& far = "beyond all numbers") {
    Outcome& outcome = run.outcome;
    outcome.stop = Stop::unstable_step;
    outcome.diagnosis = fmt::format(
        "step {} '{}' stopped at time {:g}: within {} time steps the motion grew {}, as it does where "
        "dt = {:g} is above the stable step of {} ({:.4g} when last looked at; it falls where a body stiffens); take a "
        "smaller dt (and more iterations), or an implicit timeIntegration",
        run.now.step + 1, step.name, run.now.time, run.now.increment, far, step.dt, name(run.model.settings.integrator),
        outcome.stable_step);
    return false;
  }

  void refuse(const Step& step, double limit, double frequency) {
    Outcome& outcome = run.outcome;
    outcome.stop = Stop::unstable_step;
    const std::string method = name(run.model.settings.integrator);
    const bool never = limit <= 0;
    const std::string bound =
        never ? "at any dt without damping (with damping up to 2 zeta/omega)"
              : fmt::format("above {:.4g}, as the highest frequency of the mesh is {:.4g} rad/time", limit, frequency);
    const std::string advice =
        never ? "add damping, or take symplecticEuler or an implicit timeIntegration"
              : fmt::format(
                    "take dt <= {:.3g} (and more iterations), an implicit timeIntegration, or a mesh without "
                    "small or flat elements",
                    0.95 * limit);
    outcome.diagnosis = fmt::format(
        "step {} '{}' {} time {:g}: dt = {:g}, but {} is unstable {}; {}; allowUnstable=\"true\" runs it "
        "all the same",
        run.now.step + 1, step.name, run.now.increment == 0 ? "was not begun at" : "stopped at", run.now.time, step.dt,
        method, bound, advice);
  }

  bool advance(const Step& step, const Supports& supports, int k, ScaledLoads& loads, double time) {
    const Integrator method = run.model.settings.integrator;
    const Motion before = run.now;
    Motion& now = run.now;
    const double dt = step.dt;
    const bool centred = method == Integrator::central_difference;
    run.equations.begin_step(dt);
    if (!centred) damped = run.newton.damping(now.u, loads, C);
    if (method == Integrator::forward_euler) now.u += dt * now.v;
    now.v += (centred ? 0.5 * dt : dt) * now.a;
    if (method != Integrator::forward_euler) now.u = before.u + dt * now.v;
    Vector led = centred ? now.v + 0.5 * dt * now.a : now.v;
    const Vector target = supports.at(static_cast<double>(k) / step.count, time);
    for (Eigen::Index i = 0; i < target.size(); ++i)
      if (supports.fixed[static_cast<std::size_t>(i)]) {
        now.u[i] = target[i];
        now.v[i] = (target[i] - before.u[i]) / dt;
        now.a[i] = (now.v[i] - before.v[i]) / dt;
      }
    now.time = loads.front().time = time;
    Mask given(supports.fixed.size(), 0);
    if (centred) supports.drive(time, 0, dt, now.v, now.a, given);
    for (Eigen::Index i = 0; i < target.size(); ++i)
      if (supports.fixed[static_cast<std::size_t>(i)]) led[i] = now.v[i];
    if (centred) damped = run.newton.damping(now.u, loads, C);
    balance(now.u, {now.v, led, centred ? 0.5 * dt : 0}, loads, supports, now.a);
    if (centred)
      for (Eigen::Index i = 0; i < target.size(); ++i)
        if (!supports.fixed[static_cast<std::size_t>(i)]) now.v[i] += 0.5 * dt * now.a[i];
    if (!sound(step, before, supports, loads)) return false;
    ++now.increment;
    run.set_reactions(run.newton.forces().residual(), supports);
    run.equations.end_step(now.u);
    run.account(before.u);
    if (run.model.settings.allow_unstable || !exploded(before)) return true;
    const std::string share =
        fmt::format("to {:.2g} times the energy that its start and loads put in", run.gained / put_in);
    run.now = before;
    if (stable(step, supports.fixed, loads, 0)) blown_up(step, share);
    return false;
  }

  /// Energy that nothing has put in is no motion of the body: what it begins with, and how far it goes. Steps near the
  /// stable one make some of it, and at the very start loads have not done any work yet.
  bool exploded(const Motion& before) {
    if (run.gained <= odd * put_in || put_in == 0) {
      sane.reset();
      put_in = std::max({put_in, *run.energy_at_start, std::abs(run.now.energies.external_work)});
    } else if (!sane && !run.equations.has_history()) {
      sane = before;
    }
    return put_in > 0 && run.gained > absurd * put_in;
  }

  /// To the last state that is one of the body.
  void go_back() {
    if (sane) run.now = *sane;
  }

  /// False where the state cannot be gone on from; the one before is kept then.
  bool sound(const Step& step, const Motion& before, const Supports& supports, const ScaledLoads& loads) {
    IncrementResult result;
    result.worst_element = run.newton.forces().found.smallest_J_element;
    result.worst_J = run.newton.forces().found.smallest_J;
    result.stop = run.newton.state_verdict();
    const bool finite = run.now.a.allFinite() && run.now.u.allFinite();
    if (result.stop == Stop::converged && !finite) result.stop = Stop::diverged;
    if (result.stop == Stop::converged) return true;
    run.now = before;
    // Bodies stiffen as they deform: the step may have outgrown the limit since it was last looked at.
    if (!stable(step, supports.fixed, loads, 0)) return false;
    explain(run, result, -1);
    if (run.model.settings.allow_unstable)
      run.outcome.diagnosis += "; the time step was not checked, as allowUnstable asks for";
    return false;
  }
};

}  // namespace

void run_explicit(Run& run) {
  const Model& model = run.model;
  Explicit method{run, BlockMatrix(run.newton.tangent().pattern, 0)};
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    run.now.step = static_cast<int>(s);
    const Supports supports = make_supports(step, run.equations.numbering(), run.now.u);
    if (s == 0) run.hold_start(supports);
    if (s == 0) supports.set_off(run.now.time, step.dt, run.now.v);
    ScaledLoads loads{{&run.equations.loads(run.now.step), 1.0, run.now.time}};
    method.damped = run.newton.damping(run.now.u, loads, method.C);
    run.now.a.setZero();
    supports.set_off_rates(run.now.time, step.dt, run.now.a);
    method.balance(run.now.u, {run.now.v, run.now.v}, loads, supports, run.now.a);
    run.set_reactions(run.newton.forces().residual(), supports);
    if (s == 0 && !run.sound_start()) return;
    run.mark();
    if (!method.stable(step, supports.fixed, loads, 0)) return;
    if (s == 0 && !run.accept()) return;
    const double start = run.now.time;
    for (int k = 1; k <= step.count; ++k) {
      if (!method.advance(step, supports, k, loads, start + k * step.dt)) return method.go_back();
      if (!run.accept()) return;
      if (k % watch_every == 0 && !run.equations.small_strain() &&
          !method.stable(step, supports.fixed, loads, step.count - k + 1))
        return method.go_back();
    }
  }
}

}  // namespace msml::fe
