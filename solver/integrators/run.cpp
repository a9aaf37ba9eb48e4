// SPDX-License-Identifier: GPL-3.0-or-later
// The bookkeeping that integrators share: states, reactions, energies.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "msml/core/error.hpp"
#include "solver/integrators/stepper.hpp"

namespace msml::fe {

State Run::state() const {
  const Numbering& numbering = equations.numbering();
  const Vector acting = equations.elements().acting(now.u);
  return {now.time,
          now.step,
          now.increment,
          to_points(numbering, now.u),
          to_points(numbering, now.v),
          to_points(numbering, acceleration_now.size() > 0 ? acceleration_now : now.a),
          to_points(numbering, now.reaction),
          now.energies,
          equations.elements().history_stress(),
          to_pressures(numbering, acting),
          now.load_factor,
          to_corner_pressures(numbering, now.u),
          equations.elements().history_energy(),
          to_corner_pressures(numbering, acting),
          equations.shared_elements()};
}

void Run::hold(const Step& step, const Mask& fixed) {
  free = free_motions(model, step, equations.numbering(), fixed);
  newton.free_rigid_motions(!free.modes.empty());
  if (free.modes.empty()) return;
  const std::string what =
      equations.numbering().scalar
          ? "nothing gives the level of the value; its fluxes and sources balance, and the state is "
            "one of many that differ by a constant"
          : fmt::format(
                "{} rigid motions are free; its loads balance, and the state is one of many "
                "that differ by them",
                free.modes.size());
  outcome.notes.push_back(fmt::format("step '{}': {}", step.name, what));
}

void Run::refuse_pushed_bodies() {
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    now.step = static_cast<int>(s);
    const Mask fixed = make_supports(step, equations.numbering(), now.u).fixed;
    free = free_motions(model, step, equations.numbering(), fixed);
    check_balanced({{&equations.loads(now.step), 1.0, now.time}});
  }
  free = {};
  now.step = 0;
}

double next_stop(const Step& step, double from, double to) {
  double next = to;
  const double least = from + 1e-9 * step.dt, most = to - 1e-9 * step.dt;  // round-off apart from the ends: no step
  const auto meet = [&](const std::vector<double>& kinks) {
    for (const double kink : kinks)
      if (kink > least && kink < most) next = std::min(next, kink);
  };
  const auto look = [&](const auto& conditions) {
    for (const auto& condition : conditions) meet(condition.factor.kinks);
  };
  meet(step.gravity_kinks);
  look(step.prescribed);
  look(step.forces);
  look(step.face_loads);
  look(step.body_forces);
  for (const Spring& spring : step.springs)
    for (const TimeFunction* each : {&spring.stiffness_at, &spring.damping_at, &spring.rest_at}) meet(each->kinks);
  return next;
}

bool kink_at(const Step& step, double time) {
  const double near = 2e-9 * step.dt, from = time - near, to = time + near;
  return next_stop(step, from, to) < to;
}

void Run::check_balanced(const ScaledLoads& loads) const {
  if (free.modes.empty()) return;
  Forces forces;
  equations.evaluate_loads(Vector::Zero(equations.size()), loads, forces, nullptr);
  Vector weight;  // with a body force against it nothing may be left but round-off
  const double gravity = model.steps[static_cast<std::size_t>(now.step)].gravity.norm();
  multiply(equations.mass(), Vector::Constant(equations.size(), gravity), weight);
  const double size = std::max(forces.external.norm(), weight.norm());
  for (const Vector& mode : free.modes)
    if (std::abs(dot(mode, forces.external)) > 1e-8 * size) {
      const Step& step = model.steps[static_cast<std::size_t>(now.step)];
      refuse_unbalanced(model, step, equations.numbering(), forces.external);
      throw Error(fmt::format("the loads of step '{}' push the body along a motion that nothing holds", step.name));
    }
}

bool Run::accept() {
  if (!observer || observer(state())) return true;
  outcome.stop = Stop::interrupted;
  outcome.diagnosis = fmt::format("interrupted at time {:g}, after {} increments", now.time, now.increment);
  return false;
}

void Run::set_reactions(const Vector& residual, const Supports& supports) {
  const Vector across = supports.slides.removed(residual);
  for (Eigen::Index k = 0; k < residual.size(); ++k)
    now.reaction[k] = supports.fixed[static_cast<std::size_t>(k)] ? -residual[k] : -across[k];
}

void Run::mark() {
  const Forces& forces = newton.forces();
  marked = now.time;
  external_before = forces.external;
  reaction_before = now.reaction;
  damping_before = forces.damping;
  if (equations.has_history()) internal_before = forces.internal;
  tangled = forces.found.smallest_J < 0.1;
  if (forces.found.smallest_J <= 0) last_inverted = now.time, first_inverted = first_inverted.value_or(now.time);
  measure_energies();
  const Energies& e = now.energies;
  const double held = e.elastic + e.kinetic;
  if (!energy_at_start) energy_at_start = held;
  gained = held + e.dissipated - e.external_work - *energy_at_start;
  most_gained = std::max(most_gained, gained);
  most_lost = std::max(most_lost, -gained);
  most_energy = std::max({most_energy, held, std::abs(e.external_work), e.dissipated});
}

void Run::account(const Vector& u_before) {
  const Forces& forces = newton.forces();
  const Vector moved = now.u - u_before;
  now.energies.external_work +=
      0.5 * (dot(moved, external_before + forces.external) + dot(moved, reaction_before + now.reaction));
  now.energies.external_work +=
      work_on_springs(equations.loads(now.step).springs, equations.positions(), {u_before, now.u, marked, now.time});
  now.energies.dissipated += 0.5 * dot(moved, damping_before + forces.damping);
  if (!equations.has_history()) return mark();
  const double work = 0.5 * dot(moved, internal_before + forces.internal), stored = now.energies.elastic;
  mark();
  now.energies.dissipated += work - (now.energies.elastic - stored);
}

void Run::measure_energies() {
  Energies& energies = now.energies;
  energies.elastic = newton.forces().found.energy + equations.elements().stored_beside();
  Vector p;
  multiply(equations.mass(), now.v, p);
  energies.kinetic = 0.5 * dot(now.v, p);
  energies.momentum = energies.angular_momentum = Vec3::Zero();
  const Vector& X = equations.positions();
  for (Eigen::Index k = 0; k < p.size(); k += 3) {
    const Vec3 x = X.segment<3>(k) + now.u.segment<3>(k), share = p.segment<3>(k);
    energies.momentum += share;
    energies.angular_momentum += x.cross(share);
  }
}

}  // namespace msml::fe
