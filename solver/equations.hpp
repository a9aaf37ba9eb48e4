// SPDX-License-Identifier: GPL-3.0-or-later
// The discrete equations of motion: forces and matrices at given displacements.
#pragma once
#include <utility>

#include "solver/conditions/loads.hpp"
#include "solver/conditions/prescribed.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/linear/node_geometry.hpp"

namespace msml::fe {

/// Loads that act together.
using ScaledLoads = std::vector<ActingLoads>;

/// Velocity and acceleration as functions of the displacement at the end of a time step:
/// v = velocity_factor (u - u0) + v0, a = acceleration_factor (u - u0) + a0. Statics has zero factors.
struct Kinematics {
  Vector start;  ///< u0
  double acceleration_factor = 0, velocity_factor = 0;
  Vector acceleration, velocity;  ///< a0, v0
  Mask fixed;                     ///< unknowns that follow `fixed_…` instead: their motion is given
  double dt = 0;                  ///< of fixed unknowns: v = (u - u0)/dt, a = (v - velocity_before)/dt
  Vector velocity_before;
  Mask given = {};  ///< fixed unknowns whose motion is known from a function: given_velocity, given_acceleration
  Vector given_velocity = {}, given_acceleration = {};
  double inertia_share = 1, force_share = 1;  ///< of the forces at the end of the step in the balance
  bool dynamic() const { return acceleration_factor > 0; }
  Vector velocity_at(const Vector& u) const;
  Vector acceleration_at(const Vector& u) const;
};

/// All forces at one state; the residual is external - internal - inertia - damping.
struct Forces {
  Vector external, internal, inertia, damping;
  Assembled found;  ///< by the elements
  Vector residual() const { return external - internal - inertia - damping; }
  std::size_t bytes() const {
    return fe::bytes(external) + fe::bytes(internal) + fe::bytes(inertia) + fe::bytes(damping);
  }
};

/// Model data in solver numbering. Throws nothing for a checked model but what make_loads throws.
class Equations {
 public:
  explicit Equations(const Model& model);

  const Elements& elements() const { return *elements_; }
  std::shared_ptr<const Elements> shared_elements() const { return elements_; }
  const Numbering& numbering() const { return elements_->numbering(); }
  int size() const { return 3 * numbering().nodes(); }
  const Vector& positions() const { return X_; }  ///< reference positions, 3 per numbered node
  const ScalarMatrix& mass() const { return mass_; }
  const LoadSet& loads(int step) const { return loads_[static_cast<std::size_t>(step)]; }
  NodeGeometry geometry() const;  ///< what linear solvers want to know of the nodes
  double total_mass() const;
  bool small_strain() const { return small_strain_; }  ///< true if every region's law is

  /// For materials with a history: before the increments of a time step of dt, and when its end at u is accepted.
  void begin_step(double dt) { elements_->begin_step(dt); }
  void end_step(const Vector& u) { elements_->end_step(u); }
  bool has_history() const { return has_history_; }  ///< true if forces depend on more than displacement and time

  /// Internal and external forces at u; if given, `tangent` becomes the derivative of the internal forces (symmetric),
  /// `followers` that of minus the external ones (unsymmetric, zero without follower pressure).
  void evaluate(const Vector& u, const ScaledLoads& loads, Want want, Forces& forces, BlockMatrix* tangent,
                BlockMatrix* followers = nullptr) const;
  bool has_followers() const { return has_followers_; }  ///< true if a step has a follower pressure
  /// The external forces alone.
  void evaluate_loads(const Vector& u, const ScaledLoads& loads, Forces& forces, BlockMatrix* followers) const;
  /// Inertia M a, and damping alpha M v + C w; `C` may be null, `w` is v where it is not given.
  void evaluate_motion(const Vector& velocity, const Vector& acceleration, const BlockMatrix* C, Forces& forces,
                       const Vector* w = nullptr) const;
  bool has_springs() const { return has_springs_; }  ///< true if a step has one
  bool has_dampers() const { return has_dampers_; }  ///< true if a spring of a step has one

 private:
  const Settings settings_;
  std::shared_ptr<Elements> elements_;
  Vector X_;
  ScalarMatrix mass_;
  std::vector<LoadSet> loads_;
  double poisson_ratio_ = 0;  ///< the largest of the regions
  double smallest_poisson_ratio_ = 0.5;
  bool small_strain_ = true, has_followers_ = false, has_springs_ = false, has_dampers_ = false, has_history_ = false;
};

}  // namespace msml::fe
