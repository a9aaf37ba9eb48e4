// SPDX-License-Identifier: GPL-3.0-or-later
// Methods whose balance holds between the ends of a step: what their accelerations say of the ends, and how they go on
// where the length of steps changes.
#include <cmath>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// Shares f of forces and m of inertia with which the end of a step counts.
struct Shares {
  double f, m;
};

Shares shares_of(const Run& run, const Supports& supports) {
  const Kinematics motion = kinematics(run.model.settings, run.now, supports.fixed, 1);
  return {motion.force_share, motion.inertia_share};
}

}  // namespace

bool blends(const Kinematics& motion) { return motion.force_share != 1 || motion.inertia_share != 1; }

void balance_end(Run& run, const Kinematics& motion, const Supports& supports, const Vector& before, double time) {
  const double f = motion.force_share, m = motion.inertia_share;
  const Vector balanced = run.acceleration_now.size() > 0 ? run.acceleration_now : before;
  // Where both shares are the same, so are both accelerations.
  run.acceleration_now = f == m ? run.now.a : Vector((m * run.now.a + (1 - m) * before - (1 - f) * balanced) / f);
  run.step_of_a = motion.dt;
  Mask given(supports.fixed.size(), 0);
  Vector velocity = run.now.v;
  supports.drive(time, 0, motion.dt, velocity, run.acceleration_now, given);
  for (std::size_t k = 0; k < given.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (supports.fixed[k] && !given[k]) run.acceleration_now[i] = run.now.a[i];
  }
}

void change_step(Run& run, const Supports& supports, double h) {
  if (run.acceleration_now.size() == 0 || run.step_of_a == 0) return;
  if (std::abs(run.step_of_a - h) <= 1e-9 * h) return;
  const auto [f, m] = shares_of(run, supports);
  const Vector& balanced = run.acceleration_now;
  run.now.a = balanced + (run.step_of_a / h) * (run.now.a - balanced);
  run.step_of_a = h;
  Mask given(supports.fixed.size(), 0);
  Vector velocity = run.now.v;
  supports.drive(run.now.time, (f - m) * h, h, velocity, run.now.a, given);
}

void start_anew(Run& run, const Supports& supports) {
  if (run.acceleration_now.size() == 0 || run.step_of_a == 0) return;
  const Shares shares = shares_of(run, supports);
  const Vector ahead = (shares.f - 0.5) * run.step_of_a * (run.now.a - run.acceleration_now);
  for (Eigen::Index k = 0; k < ahead.size(); ++k)
    if (!supports.fixed[static_cast<std::size_t>(k)]) run.now.v[k] += ahead[k];
  run.now.a = run.acceleration_now;
  run.step_of_a = 0;
}

}  // namespace msml::fe
