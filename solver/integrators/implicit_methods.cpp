// SPDX-License-Identifier: GPL-3.0-or-later
// Backward Euler, Newmark's method and the generalised-alpha method as ties between displacement, velocity and
// acceleration.
#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// v1 = (u1 - u0)/dt, a1 = (v1 - v0)/dt = (u1 - u0)/dt^2 - v0/dt.
void backward_euler(const Motion& now, double dt, Kinematics& k) {
  k.velocity_factor = 1 / dt;
  k.acceleration_factor = 1 / (dt * dt);
  k.velocity = Vector::Zero(now.u.size());
  k.acceleration = -now.v / dt;
}

/// u1 = u0 + dt v0 + dt^2 ((1/2 - beta) a0 + beta a1), v1 = v0 + dt ((1 - gamma) a0 + gamma a1)
/// (Newmark 1959, doi 10.1061/JMCEA3.0000098), solved for a1 and v1.
void newmark(const Motion& now, double beta, double gamma, double dt, Kinematics& k) {
  k.velocity_factor = gamma / (beta * dt);
  k.acceleration_factor = 1 / (beta * dt * dt);
  k.velocity = (1 - gamma / beta) * now.v + dt * (1 - gamma / (2 * beta)) * now.a;
  k.acceleration = -now.v / (beta * dt) - (1 / (2 * beta) - 1) * now.a;
}

/// Newmark's ties; the balance holds between the ends of the step: inertia counts with 1 - alpha_m of its end and
/// alpha_m of its start, all other forces with 1 - alpha_f and alpha_f. Least low-frequency damping for a spectral
/// radius r at infinite frequency: alpha_m = (2r - 1)/(r + 1), alpha_f = r/(r + 1), gamma = 1/2 - alpha_m + alpha_f,
/// beta = (1 - alpha_m + alpha_f)^2/4 (Chung and Hulbert 1993, doi 10.1115/1.2900803, eqs. 17, 20, 25).
void generalized_alpha(const Motion& now, double radius, double dt, Kinematics& k) {
  const double alpha_m = (2 * radius - 1) / (radius + 1), alpha_f = radius / (radius + 1);
  const double wide = 1 - alpha_m + alpha_f;
  newmark(now, wide * wide / 4, wide - 0.5, dt, k);
  k.inertia_share = 1 - alpha_m;
  k.force_share = 1 - alpha_f;
}

}  // namespace

Kinematics kinematics(const Settings& settings, const Motion& now, const Mask& fixed, double dt) {
  Kinematics k{.start = now.u, .fixed = fixed, .dt = dt, .velocity_before = now.v};
  if (settings.integrator == Integrator::newmark)
    newmark(now, settings.newmark_beta, settings.newmark_gamma, dt, k);
  else if (settings.integrator == Integrator::generalized_alpha)
    generalized_alpha(now, settings.spectral_radius, dt, k);
  else
    backward_euler(now, dt, k);
  return k;
}

}  // namespace msml::fe
