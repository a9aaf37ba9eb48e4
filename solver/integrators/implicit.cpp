// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit time steps: the loop that backward Euler, Newmark's and the generalised-alpha method share.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// What the start of the step leaves for its end to balance; empty where only the end counts.
Vector carried(const Kinematics& motion, const Forces& start) {
  if (!blends(motion)) return {};
  return (1 - motion.inertia_share) * start.inertia -
         (1 - motion.force_share) * (start.external - start.internal - start.damping);
}

Forces mixed(const Kinematics& motion, const Forces& start, const Forces& end) {
  const double f = motion.force_share, m = motion.inertia_share;
  return {f * end.external + (1 - f) * start.external, f * end.internal + (1 - f) * start.internal,
          m * end.inertia + (1 - m) * start.inertia, f * end.damping + (1 - f) * start.damping, end.found};
}

/// Everything that the time steps within one stage share.
struct Stage {
  Run& run;
  const Step& step;
  const Supports& supports;
  double start;
  BlockMatrix& C;                         ///< damping beside alpha M that the time step is taken with
  double size = 0;                        ///< largest displacement so far, see size_of()
  std::optional<BlockMatrix> C_end = {};  ///< the same at the end of the time step, see turned()
  bool C_end_current = false;             ///< it belongs to the end of the step that was tried last
  bool C_current = false;                 ///< C belongs to the present displacement
};

struct Trial {
  Increment increment;
  IncrementResult result;
  Vector velocity, acceleration;
  double turned = 0;  ///< what is left of turned()
};

/// Supports that move by functions of time have the velocity and acceleration of these. Backward Euler takes
/// differences, as it does everywhere.
void follow(const Supports& supports, double time, Kinematics& motion) {
  if (supports.moved.empty()) return;
  motion.given.assign(supports.fixed.size(), 0);
  motion.given_velocity = motion.given_acceleration = Vector::Zero(motion.start.size());
  // Where the balance holds between the ends of the step, the accelerations at the ends belong to times apart from
  // them.
  const double shift = (motion.force_share - motion.inertia_share) * motion.dt;
  supports.drive(time, shift, motion.dt, motion.given_velocity, motion.given_acceleration, motion.given);
}

/// How far what damps has turned or stiffened with the body, as a share of all forces: K x_dot = 0 holds where the body
/// is, a damper acts along its present line, and the velocity is that of the end of the step. C_end then is the damping
/// there. With one linear solve per step it is that of the start.
double turned(Stage& stage, const Trial& trial) {
  Run& run = stage.run;
  stage.C_end_current = false;
  if (run.model.settings.newton_iterations == 1 || run.equations.small_strain()) return 0;
  if (!stage.C_end) stage.C_end.emplace(stage.C.pattern);
  run.newton.damping(trial.result.u, trial.increment.loads, *stage.C_end);
  stage.C_end_current = true;
  Vector at_start, at_end;
  const Vector velocity = trial.increment.motion.velocity_at(trial.result.u);
  multiply(stage.C, velocity, at_start);
  multiply(*stage.C_end, velocity, at_end);
  Vector change = at_end - at_start;
  stage.supports.slides.project(change);
  const double size = free_norm(change, stage.supports.fixed);
  return size > 0 ? size / trial.result.scale : 0;
}

constexpr int most_turns = 12;
constexpr double tolerable_turn = 1e-3;  // backward Euler has no second order to lose

/// Newton's way to the end of the step, again from there while the damping turned. The rest falls by about half of the
/// step's rotation or strain each time; where it does not, round-off is all that is left, or the step too large.
IncrementResult reach(Stage& stage, Trial& trial) {
  Run& run = stage.run;
  const Settings& settings = run.model.settings;
  trial.result = run.reach(trial.increment);
  if (trial.result.stop != Stop::converged || !trial.increment.damping_matrix) return trial.result;
  const double enough = settings.integrator == Integrator::implicit_euler ? tolerable_turn : settings.tolerance;
  double before = std::numeric_limits<double>::infinity();
  for (int turn = 0;; ++turn) {
    trial.turned = turned(stage, trial);
    if (trial.turned <= enough || turn == most_turns || !(trial.turned < 0.5 * before)) return trial.result;
    before = trial.turned;
    trial.increment.start = trial.result.u;
    std::swap(stage.C.values, stage.C_end->values);
    stage.C_end_current = false;
    run.newton.forget();
    trial.increment.near = true;
    IncrementResult next = run.newton.run(trial.increment);
    trial.increment.near = false;
    if (next.stop != Stop::converged) next = run.reach(trial.increment);
    if (next.stop != Stop::converged) {
      std::swap(stage.C.values, stage.C_end->values);
      run.newton.forget();
      return trial.result;
    }
    trial.result = std::move(next);
  }
}

/// Size of the forces that moving supports put into a body, as far as its tangent at the end of the step tells: from
/// rest no others may act.
double support_force(const Run& run, const Trial& trial) {
  Vector moved = trial.result.u - trial.increment.start, force;
  for (std::size_t k = 0; k < trial.increment.fixed.size(); ++k)
    if (!trial.increment.fixed[k]) moved[static_cast<Eigen::Index>(k)] = 0;
  multiply(run.newton.tangent(), moved, force);
  return force.norm();
}

/// The step from the present state to a time; nothing is kept.
Trial try_step(Stage& stage, double time, const Forces& start_forces, bool damped) {
  Run& run = stage.run;
  const Settings& settings = run.model.settings;
  const double h = time - run.now.time, share = (time - stage.start) / (stage.step.dt * stage.step.count);
  Trial trial{.increment = {run.now.u,
                            stage.supports.fixed,
                            stage.supports.at(share, time),
                            {{&run.equations.loads(run.now.step), 1.0, time}},
                            kinematics(settings, run.now, stage.supports.fixed, h),
                            damped ? &stage.C : nullptr,
                            {},
                            &stage.supports.slides}};
  if (settings.integrator != Integrator::implicit_euler) follow(stage.supports, time, trial.increment.motion);
  trial.increment.offset = carried(trial.increment.motion, start_forces);
  // Where the motion so far leads: the last steps of backward Euler on a line, Newmark's start of a step.
  const bool euler = settings.integrator == Integrator::implicit_euler;
  trial.increment.expected = h * run.now.v + (euler ? 1 : 0.5) * h * h * run.now.a;
  run.equations.begin_step(h);
  if (run.equations.has_history()) run.newton.forget();
  trial.result = reach(stage, trial);
  if (trial.result.stop != Stop::converged) return trial;
  trial.velocity = trial.increment.motion.velocity_at(trial.result.u);
  trial.acceleration = trial.increment.motion.acceleration_at(trial.result.u);
  run.newton.prepare(trial.result.u, trial.increment.loads);
  run.newton.move(trial.velocity, trial.acceleration, trial.increment.damping_matrix);
  if (settings.newton_iterations == 1) {
    trial.result.worst_element = run.newton.forces().found.smallest_J_element;
    trial.result.worst_J = run.newton.forces().found.smallest_J;
    trial.result.stop = run.newton.state_verdict();
    // One linear solve leaves a residual; one far beyond all forces is no answer to go on from.
    const double left = free_norm(run.newton.residual(trial.increment), stage.supports.fixed);
    const bool far = left > 1e6 * trial.result.scale && left > 1e6 * support_force(run, trial);
    if (trial.result.stop == Stop::converged && far) trial.result.stop = Stop::diverged;
  }
  return trial;
}

/// Root of the sum of squares over the nodes of the body: pressures are no motion.
double size_of(const Run& run, const Vector& motion) {
  return motion.head(3 * run.equations.numbering().body_nodes()).norm();
}

void keep(Stage& stage, const Trial& trial, double time, const Forces& start_forces) {
  Run& run = stage.run;
  const Vector before = run.now.u, accelerated_before = run.now.a;
  run.now.u = trial.result.u;
  run.now.v = trial.velocity;
  run.now.a = trial.acceleration;
  Vector residual = run.newton.forces().residual();
  if (blends(trial.increment.motion)) {
    run.between = mixed(trial.increment.motion, start_forces, run.newton.forces());
    balance_end(run, trial.increment.motion, stage.supports, accelerated_before, time);
    Vector inertia;
    multiply(run.equations.mass(), run.acceleration_now, inertia);
    residual += run.newton.forces().inertia - inertia;
    if (run.model.settings.adaptive_step && kink_at(stage.step, time)) start_anew(run, stage.supports);
  }
  run.now.time = time;
  run.set_reactions(residual, stage.supports);
  run.equations.end_step(run.now.u);
  run.account(before);
  if (stage.C_end_current) std::swap(stage.C.values, stage.C_end->values);
  stage.C_current = std::exchange(stage.C_end_current, false);
  run.unsettled += trial.turned > tolerable_turn;
  stage.size = std::max(stage.size, size_of(run, run.now.u));
  ++run.pieces;
}

/// Local error of a step of h beside what may be, 1 at the limit: the term of the displacement's expansion that the
/// method misses, h^2 (beta - 1/6)(a1 - a0) for Newmark's family (Zienkiewicz and Xie 1991, doi
/// 10.1002/eqe.4290200902) and h^2/2 a1 for backward Euler, beside the displacement so far, or where there is none
/// yet, what the motion makes of a whole time step of the scene.
double error_of(const Stage& stage, const Trial& trial, double h) {
  const Settings& settings = stage.run.model.settings;
  const Motion& now = stage.run.now;
  const bool euler = settings.integrator == Integrator::implicit_euler;
  const double beta = 1 / (trial.increment.motion.acceleration_factor * h * h);
  Vector missed = euler ? Vector(0.5 * h * h * trial.acceleration)
                        : Vector(h * h * (beta - 1.0 / 6) * (trial.acceleration - now.a));
  const auto free_size = [&](Vector motion) {
    for (Eigen::Index k = 0; k < motion.size(); ++k)
      if (stage.supports.fixed[static_cast<std::size_t>(k)]) motion[k] = 0;
    return size_of(stage.run, motion);
  };
  const double dt = stage.step.dt;
  const double size = std::max({stage.size, size_of(stage.run, trial.result.u), dt * size_of(stage.run, now.v),
                                0.5 * dt * dt * free_size(trial.acceleration)});
  return size > 0 ? free_size(std::move(missed)) / (settings.step_tolerance * size) : 0;
}

/// A step that failed: looks whether a shorter one from the same state does not, and says so.
std::string find_cause(Stage& stage, const Forces& start_forces, bool damped, IncrementResult& result) {
  Run& run = stage.run;
  if (result.stop != Stop::newton_limit && result.stop != Stop::diverged) return "";
  if (stage.run.model.settings.adaptive_step) return cause_of_iterations(stage.run, result);
  for (double h = stage.step.dt / 4; h > stage.step.dt / 5000; h /= 4) {
    run.newton.go_back(start_forces);
    if (try_step(stage, run.now.time + h, start_forces, damped).result.stop != Stop::converged) continue;
    result.stop = Stop::step_too_large;
    return fmt::format("from the same state a step of {:.3g} is solved", h);
  }
  return cause_of_iterations(stage.run, result);
}

/// To the next reported state; false if that failed, and the outcome is explained.
bool advance(Stage& stage, double target) {
  Run& run = stage.run;
  const Settings& settings = run.model.settings;
  const double dt = stage.step.dt, smallest = dt / 4096;
  double h = settings.adaptive_step && run.piece > 0 ? std::clamp(run.piece, smallest, dt) : dt;
  while (run.now.time < target) {
    const double stop = settings.adaptive_step ? next_stop(stage.step, run.now.time, target) : target;
    const bool last = run.now.time + 1.0001 * h >= stop;
    const double time = last ? stop : run.now.time + h, taken = time - run.now.time;
    Forces start_forces;
    if (blends(kinematics(settings, run.now, stage.supports.fixed, taken))) {
      change_step(run, stage.supports, taken);
      start_forces = run.newton.forces();
      multiply(run.equations.mass(), run.now.a, start_forces.inertia);
    }
    const ScaledLoads loads{{&run.equations.loads(run.now.step), 1.0, time}};
    const bool damped = std::exchange(stage.C_current, false) || run.newton.damping(run.now.u, loads, stage.C);
    Trial trial = try_step(stage, time, start_forces, damped);
    const bool solved = trial.result.stop == Stop::converged;
    const double order = settings.integrator == Integrator::implicit_euler ? 2 : 3;
    const double error = solved && settings.adaptive_step ? error_of(stage, trial, taken) : 0;
    const double factor = solved ? std::clamp(0.9 * std::pow(std::max(error, 1e-6), -1 / order), 0.2, 2.0) : 0.5;
    const bool hopeless = trial.result.stop == Stop::out_of_memory;  // a singular matrix is not, as M/dt^2 grows
    if (!solved && (!settings.adaptive_step || hopeless || taken / 2 < smallest)) {
      const std::string evidence = find_cause(stage, start_forces, damped, trial.result);
      return explain(run, trial.result, -1, evidence), false;
    }
    if (!solved || (error > 1 && taken * factor >= smallest)) {
      h = taken * factor;
      run.halved += !solved;
      run.newton.go_back(start_forces);
      continue;
    }
    keep(stage, trial, time, start_forces);
    const double grown = taken * (trial.result.residuals.size() > 8 ? std::min(factor, 0.7) : factor);
    h = last ? std::max(h, std::min(grown, dt)) : grown;
    if (last && grown < taken) h = grown;
    run.piece = h;
  }
  ++run.now.increment;
  return true;
}

}  // namespace

void run_implicit(Run& run) {
  const Model& model = run.model;
  BlockMatrix C(run.newton.tangent().pattern, 0);
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    run.now.step = static_cast<int>(s);
    const Supports supports = make_supports(step, run.equations.numbering(), run.now.u);
    if (s == 0) run.begin_motion(step, supports);
    if (s > 0) start_anew(run, supports);
    if (s > 0) run.jump_with_supports(step, supports);
    run.begin_balance(step, supports);  // loads and supports may jump between steps, and the acceleration with them
    if (s == 0 && !run.sound_start()) return;
    run.mark();
    if (s == 0 && !run.accept()) return;
    Stage stage{run, step, supports, run.now.time, C, size_of(run, run.now.u)};
    for (int k = 1; k <= step.count; ++k)
      if (!advance(stage, stage.start + k * step.dt) || !run.accept()) return;
  }
}

}  // namespace msml::fe
