// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit time steps: the loop that backward Euler, Newmark's and the generalised-alpha method share.
#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// What the start of the step leaves for its end to balance; empty where only the end counts.
Vector carried(const Kinematics& motion, const Forces& start) {
  if (motion.force_share == 1 && motion.inertia_share == 1) return {};
  return (1 - motion.inertia_share) * start.inertia -
         (1 - motion.force_share) * (start.external - start.internal - start.damping);
}

Forces mixed(const Kinematics& motion, const Forces& start, const Forces& end) {
  const double f = motion.force_share, m = motion.inertia_share;
  return {f * end.external + (1 - f) * start.external, f * end.internal + (1 - f) * start.internal,
          m * end.inertia + (1 - m) * start.inertia, f * end.damping + (1 - f) * start.damping, end.found};
}

/// One time step; false if it failed, and the outcome is explained.
bool advance(Run& run, Increment& increment, const Supports& supports, double time, BlockMatrix& C) {
  Newton& newton = run.newton;
  const Kinematics& motion = increment.motion;
  const bool blends = motion.force_share != 1 || motion.inertia_share != 1;
  const Forces start = blends ? newton.forces() : Forces{};
  increment.offset = carried(motion, start);
  run.equations.begin_step(motion.dt);
  if (run.equations.has_history()) newton.forget();
  if (newton.damping(run.now.u, increment.loads, C)) increment.damping_matrix = &C;
  const IncrementResult result = newton.walk(increment);
  if (result.stop != Stop::converged) return explain(run, result, -1), false;
  const Vector velocity = motion.velocity_at(result.u), acceleration = motion.acceleration_at(result.u);
  newton.prepare(result.u, increment.loads);
  newton.move(velocity, acceleration, increment.damping_matrix);
  if (run.model.settings.newton_iterations == 1) {
    IncrementResult checked = result;
    checked.worst_element = newton.forces().found.smallest_J_element;
    checked.worst_J = newton.forces().found.smallest_J;
    checked.stop = newton.state_verdict();
    if (checked.stop != Stop::converged) return explain(run, checked, -1), false;
  }
  const Vector before = run.now.u;
  run.now.u = result.u;
  run.now.v = velocity;
  run.now.a = acceleration;
  run.now.time = time;
  ++run.now.increment;
  run.set_reactions(newton.residual(increment), supports);
  if (blends) run.between = mixed(motion, start, newton.forces());
  run.account(before);
  run.equations.end_step(result.u);
  return true;
}

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

}  // namespace

void run_implicit(Run& run) {
  const Model& model = run.model;
  BlockMatrix C(run.newton.tangent().pattern);
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    run.now.step = static_cast<int>(s);
    ScaledLoads loads{{&run.equations.loads(run.now.step), 1.0, run.now.time}};
    const Supports supports = make_supports(step, run.equations.numbering(), run.now.u);
    if (s == 0) supports.set_off(run.now.time, step.dt, run.now.v);
    // Loads and supports may jump between steps, and the acceleration with them.
    run.now.a = run.newton.initial_acceleration(run.now.u, run.now.v, loads, supports);
    run.set_reactions(run.newton.forces().residual(), supports);
    run.mark();
    if (s == 0 && !run.accept()) return;
    const double start = run.now.time;
    for (int k = 1; k <= step.count; ++k) {
      const double time = start + k * step.dt;
      loads.front().time = time;
      Increment increment{run.now.u,
                          supports.fixed,
                          supports.at(static_cast<double>(k) / step.count, time),
                          loads,
                          kinematics(model.settings, run.now, supports.fixed, step.dt),
                          nullptr,
                          {},
                          &supports.slides};
      if (model.settings.integrator != Integrator::implicit_euler) follow(supports, time, increment.motion);
      if (!advance(run, increment, supports, time, C) || !run.accept()) return;
    }
  }
}

}  // namespace msml::fe
