// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit time steps: backward Euler, and Newmark's method with constant average acceleration.
#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// Both methods give velocity and acceleration as linear functions of the new displacement u1.
/// Backward Euler: v1 = (u1 - u0)/dt, a1 = (v1 - v0)/dt = (u1 - u0)/dt^2 - v0/dt.
/// Newmark, beta = 1/4, gamma = 1/2: u1 = u0 + dt v0 + dt^2/4 (a0 + a1), v1 = v0 + dt/2 (a0 + a1), hence
/// a1 = 4 (u1 - u0)/dt^2 - 4 v0/dt - a0 and v1 = 2 (u1 - u0)/dt - v0 (Newmark 1959, doi 10.1061/JMCEA3.0000098).
/// The balance at the end of the step, M a1 + (alpha M + beta K0) v1 + f_int(u1) = f_ext(u1), then has u1 alone as
/// unknown; K0 is the semidefinite tangent at the start of the step.
Kinematics kinematics(Integrator integrator, const Motion& now, const Mask& fixed, double dt) {
  Kinematics k{.start = now.u, .fixed = fixed, .dt = dt, .velocity_before = now.v};
  if (integrator == Integrator::implicit_euler) {
    k.velocity_factor = 1 / dt;
    k.acceleration_factor = 1 / (dt * dt);
    k.velocity = Vector::Zero(now.u.size());
    k.acceleration = -now.v / dt;
  } else {
    k.velocity_factor = 2 / dt;
    k.acceleration_factor = 4 / (dt * dt);
    k.velocity = -now.v;
    k.acceleration = -4 / dt * now.v - now.a;
  }
  return k;
}

}  // namespace

void run_dynamic(Run& run) {
  const Model& model = run.model;
  const Settings& settings = model.settings;
  const bool damped = settings.damping_stiffness > 0, single = settings.newton_iterations == 1;
  BlockMatrix K0(run.newton.tangent().pattern);
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    run.now.step = static_cast<int>(s);
    ScaledLoads loads{{&run.equations.loads(static_cast<int>(s)), 1.0, run.now.time}};
    const Supports supports = make_supports(step, run.equations.numbering(), run.now.u);
    // Loads and supports may jump between steps, and the acceleration with them.
    run.now.a = run.newton.initial_acceleration(run.now.u, run.now.v, loads, supports.fixed);
    run.set_reactions(supports.fixed);
    if (s == 0 && !run.accept()) return;
    const double start = run.now.time;
    for (int k = 1; k <= step.count; ++k) {
      const double time = start + k * step.dt;
      loads.front().time = time;
      Increment increment{run.now.u,
                          supports.fixed,
                          supports.at(static_cast<double>(k) / step.count, time),
                          loads,
                          kinematics(settings.integrator, run.now, supports.fixed, step.dt),
                          nullptr};
      if (damped) {
        run.newton.stiffness(run.now.u, K0);
        increment.damping_matrix = &K0;
      }
      const IncrementResult result = run.newton.walk(increment);
      if (result.stop != Stop::converged) return explain(run, result, -1);
      const Vector velocity = increment.motion.velocity_at(result.u);
      const Vector acceleration = increment.motion.acceleration_at(result.u);
      run.newton.prepare(result.u, loads);
      run.newton.move(velocity, acceleration, increment.damping_matrix);
      IncrementResult checked = result;
      checked.worst_element = run.newton.forces().found.smallest_J_element;
      checked.worst_J = run.newton.forces().found.smallest_J;
      checked.stop = run.newton.state_verdict();
      if (single && checked.stop != Stop::converged) return explain(run, checked, -1);
      run.now.u = result.u;
      run.now.v = velocity;
      run.now.a = acceleration;
      run.now.time = time;
      ++run.now.increment;
      run.set_reactions(supports.fixed);
      if (!run.accept()) return;
    }
  }
}

}  // namespace msml::fe
