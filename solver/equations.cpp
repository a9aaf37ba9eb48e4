// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates forces and tangents.
#include "solver/equations.hpp"

#include <algorithm>

#include "solver/pieces.hpp"

namespace msml::fe {

namespace {

/// A rate of each unknown: by `free` where it is free, given_rate where a function says it, otherwise by `moved`.
template <class Free, class Moved>
Vector rates(const Kinematics& motion, Free&& free, const Vector& given_rate, Moved&& moved) {
  Vector rate(motion.start.size());
  for_pieces(rate.size(), [&](long, long first, long last) {
    for (long i = first; i < last; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const bool given = !motion.given.empty() && motion.given[k];
      rate[i] = !motion.fixed[k] ? free(i) : given ? given_rate[i] : moved(i);
    }
  });
  return rate;
}

}  // namespace

Vector Kinematics::velocity_at(const Vector& u) const {
  if (!dynamic()) return Vector::Zero(u.size());
  return rates(
      *this, [&](long i) { return velocity_factor * (u[i] - start[i]) + velocity[i]; }, given_velocity,
      [&](long i) { return (u[i] - start[i]) / dt; });
}

Vector Kinematics::acceleration_at(const Vector& u) const {
  if (!dynamic()) return Vector::Zero(u.size());
  return rates(
      *this, [&](long i) { return acceleration_factor * (u[i] - start[i]) + acceleration[i]; }, given_acceleration,
      [&](long i) { return ((u[i] - start[i]) / dt - velocity_before[i]) / dt; });
}

Equations::Equations(const Model& model)
    : settings_(model.settings),
      elements_(make_elements(model)),
      X_(to_vector(elements_->numbering(), model.mesh->points)),
      mass_(elements_->pattern()) {
  for (const PointMass& point : model.point_masses) {
    const auto node = static_cast<std::size_t>(numbering().number_of[static_cast<std::size_t>(point.node)]);
    mass_.values[static_cast<std::size_t>(mass_.pattern->diagonal[node])] += point.mass;
  }
  elements_->add_mass((settings_.lumped_mass && is_dynamic(settings_.integrator)) || is_explicit(settings_.integrator),
                      mass_);
  for (const Region& region : model.regions)
    if (!region.elements.empty()) {
      small_strain_ = small_strain_ && region.law->small_strain();
      poisson_ratio_ = std::max(poisson_ratio_, region.law->poisson_ratio());
      smallest_poisson_ratio_ = std::min(smallest_poisson_ratio_, region.law->poisson_ratio());
    }
  for (const Inlay& inlay : model.inlays) small_strain_ = small_strain_ && inlay.region.law->small_strain();
  for (const Region& region : model.regions) has_history_ = has_history_ || !region.prony.tau.empty();
  for (const Step& step : model.steps) loads_.push_back(make_loads(model, step, numbering(), mass_));
  for (const LoadSet& set : loads_) {
    has_followers_ = has_followers_ || !set.followers.empty();
    has_springs_ = has_springs_ || !set.springs.empty();
    for (const SpringLink& spring : set.springs) has_dampers_ = has_dampers_ || spring.damping > 0 || spring.damping_at;
  }
  if (has_springs_) small_strain_ = false;
}

NodeGeometry Equations::geometry() const {
  const bool tetrahedra = numbering().kind == CellKind::tet4 || numbering().kind == CellKind::tet10;
  return {X_, edge_ends(numbering()), tetrahedra && numbering().components == 3, poisson_ratio_,
          smallest_poisson_ratio_};
}

double Equations::total_mass() const {
  double sum = 0;
  for (const double m : mass_.values) sum += m;
  return sum;
}

void Equations::evaluate(const Vector& u, const ScaledLoads& loads, Want want, Forces& forces, BlockMatrix* tangent,
                         BlockMatrix* followers) const {
  forces.internal = Vector::Zero(size());
  forces.found = elements_->add_internal(u, want, forces.internal, tangent);
  for (const ActingLoads& acting : loads)
    if (!acting.leaving)
      forces.found.energy += add_springs(acting.set->springs, acting.time, X_, u, want == Want::definite_tangent,
                                         forces.internal, tangent);
  evaluate_loads(u, loads, forces, followers);
}

void Equations::evaluate_loads(const Vector& u, const ScaledLoads& loads, Forces& forces,
                               BlockMatrix* followers) const {
  forces.external = Vector::Zero(size());
  if (followers) followers->set_zero();
  for (const ActingLoads& acting : loads) {
    add_dead(acting, forces.external);
    add_followers(acting, X_, u, forces.external, followers);
  }
}

void Equations::evaluate_motion(const Vector& velocity, const Vector& acceleration, const BlockMatrix* C,
                                Forces& forces, const Vector* w) const {
  multiply(mass_, acceleration, forces.inertia);
  forces.damping = Vector::Zero(size());
  Vector product;
  if (settings_.damping_mass > 0) {
    multiply(mass_, velocity, product);
    forces.damping += settings_.damping_mass * product;
  }
  if (C) {
    multiply(*C, w ? *w : velocity, product);
    forces.damping += product;
  }
}

}  // namespace msml::fe
