// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method with backtracking, for statics and for implicit time steps.
#include "solver/newton.hpp"

#include <algorithm>
#include <cmath>

#include "solver/pieces.hpp"
#include "solver/stopwatch.hpp"

namespace msml::fe {
namespace {

Stop stop_of(LinearStatus status) {
  switch (status) {
    case LinearStatus::limit:
      return Stop::linear_solver_limit;
    case LinearStatus::not_positive_definite:
      return Stop::indefinite_tangent;
    case LinearStatus::out_of_memory:
      return Stop::out_of_memory;
    case LinearStatus::singular:
      return Stop::singular;
    case LinearStatus::done:
      break;
  }
  return Stop::converged;
}

}  // namespace

Newton::Newton(const Model& model, const Equations& equations)
    : model_(model),
      equations_(equations),
      extent_(model.mesh->points.colwise().maxCoeff() - model.mesh->points.colwise().minCoeff()),
      linear_(equations.numbering().mixed() ? make_indefinite(model.settings.threads, model.settings.pulse)
                                            : make_linear_system(model.settings, equations.geometry())),
      tangent_(equations.elements().pattern()),
      effective_(equations.elements().pattern(), 0),
      want_(model.settings.newton_iterations == 1 ? Want::single_tangent : Want::tangent) {
  searching_ = model.settings.line_search;
  survives_.assign(model.mesh->kinds.size(), 0);
  for (const Region& region : model.regions)
    for (const int e : region.elements) survives_[static_cast<std::size_t>(e)] = region.law->survives_inversion();
  for (const Region& region : model.regions)
    barrier_ = barrier_ || (!region.law->survives_inversion() && !region.law->small_strain());
  energetic_ = !equations.has_followers() && !equations.has_history() &&
               (model.formulation == Formulation::standard || model.formulation == Formulation::fbar);
  // Nothing else may add to it.
  const bool alone = !equations.has_followers() && !equations.has_springs() && model.settings.damping_stiffness == 0;
  if (want_ == Want::single_tangent && is_dynamic(model.settings.integrator) && alone)
    kept_ = equations.elements().kept_tangent();
  if (equations.has_followers()) followers_ = std::make_unique<BlockMatrix>(equations.elements().pattern());
}

void Newton::evaluate(const Increment& increment, const Vector& u, Want want, bool with_tangent) {
  pulse();
  const Stopwatch watch(seconds_assembly_);
  if (with_tangent) linear_->place(u);
  equations_.evaluate(u, increment.loads, want, forces_, with_tangent ? place_of(want) : nullptr,
                      with_tangent ? followers_.get() : nullptr);
  equations_.evaluate_motion(increment.motion.velocity_at(u), increment.motion.acceleration_at(u),
                             increment.damping_matrix, forces_);
}

namespace {

/// The springs that act: internal forces and tangent hold theirs.
ActingSprings springs_of(const ScaledLoads& loads) {
  for (const ActingLoads& acting : loads)
    if (!acting.leaving && !acting.set->springs.empty())
      return {acting.set, vary(acting.set->springs) ? acting.time : 0};
  return {};
}

}  // namespace

void Newton::prepare(const Vector& u, const ScaledLoads& loads) {
  pulse();
  const Stopwatch watch(seconds_assembly_);
  linear_->place(u);
  equations_.evaluate(u, loads, want_, forces_, place_of(want_), followers_.get());
  tangent_current_ = true;
  springs_in_tangent_ = springs_of(loads);
}

void Newton::look(const Vector& u, const ScaledLoads& loads) {
  pulse();
  const Stopwatch watch(seconds_assembly_);
  equations_.evaluate(u, loads, Want::stress, forces_, nullptr);
  tangent_current_ = false;
}

void Newton::stiffness(const Vector& u, const ScaledLoads& loads, BlockMatrix& K) {
  const Stopwatch watch(seconds_assembly_);
  Forces unused;
  equations_.evaluate(u, loads, Want::definite_tangent, unused, &K);
  // Pressures have no rate: changes of shape alone are damped.
  const Numbering& numbering = equations_.numbering();
  for (int row = 0; numbering.mixed() && row < K.pattern->nodes(); ++row)
    for (int p = K.pattern->offsets[static_cast<std::size_t>(row)];
         p < K.pattern->offsets[static_cast<std::size_t>(row) + 1]; ++p)
      if (std::max(row, K.pattern->columns[static_cast<std::size_t>(p)]) >= numbering.body_nodes())
        std::fill_n(K.values.begin() + 9 * static_cast<long>(p), 9, 0.0);
}

bool Newton::damping(const Vector& u, const ScaledLoads& loads, BlockMatrix& C) {
  const double beta = model_.settings.damping_stiffness;
  if (beta == 0 && !equations_.has_dampers()) return false;
  if (beta > 0) {
    stiffness(u, loads, C);
    for (double& value : C.values) value *= beta;
  } else {
    C.set_zero();
  }
  for (const ActingLoads& acting : loads)
    if (!acting.leaving) add_dampers(acting.set->springs, acting.time, equations_.positions(), u, C);
  return true;
}

bool Newton::indefinite(LinearStatus status) const {
  const auto pressures = static_cast<long>(equations_.numbering().pressure_of.size());
  // With a stable equilibrium each pressure adds one negative pivot (Benzi, Golub and Liesen 2005,
  // doi 10.1017/S0962492904000212, section 3.4).
  if (pressures > 0) return status == LinearStatus::done && linear_->negative_pivots() != pressures;
  return status == LinearStatus::not_positive_definite;
}

bool Newton::unstable_whole() const {
  const bool odd = equations_.numbering().pressure_of.size() % 2 == 1;
  return unsymmetric_->negative_determinant() != odd;
}

Vector Newton::residual(const Increment& increment) const {
  const Kinematics& motion = increment.motion;
  const Forces& f = forces_;
  Vector residual(f.external.size());
  for_pieces(residual.size(), [&](long, long first, long last) {
    const auto part = [=](const Vector& v) { return v.segment(first, last - first); };
    residual.segment(first, last - first) =
        motion.force_share * (part(f.external) - part(f.internal) - part(f.damping)) -
        motion.inertia_share * part(f.inertia);
  });
  if (increment.offset.size() > 0) residual -= increment.offset;
  return residual;
}

Vector Newton::free_residual(const Increment& increment) const {
  Vector residual = this->residual(increment);
  if (increment.slides) increment.slides->project(residual);
  return residual;
}

LinearStatus Newton::direction(const Increment& increment, const Vector& u, const Vector& jump, const Vector& residual,
                               Vector& step) {
  const Definiteness choice = model_.settings.definiteness;
  if (choice != Definiteness::always && !insist_definite_) {
    const LinearStatus status = attempt(increment, jump, residual, step);
    // Conjugate gradients notice an indefinite matrix in the solve, a factorisation before it.
    indefinite_ = whole_taken_ ? unstable_whole() : indefinite(status);
    if (!indefinite_ || choice == Definiteness::never) return status;
  }
  evaluate(increment, u, Want::definite_tangent, true);
  tangent_current_ = false;
  definite_taken_ = true, ++definite_;
  LinearStatus status = attempt(increment, jump, residual, step);
  // A body crumpled to a point has no stiffness in some direction: a little on the diagonal bounds the step.
  if (status == LinearStatus::not_positive_definite && energetic_ && forces_.found.smallest_J < 0.1) {
    lifted_ = true;
    status = attempt(increment, jump, residual, step);
    lifted_ = false;
  }
  // A semidefinite matrix without a factorisation.
  return status == LinearStatus::not_positive_definite ? LinearStatus::singular : status;
}

void Newton::move(const Vector& velocity, const Vector& acceleration, const BlockMatrix* damping_matrix,
                  const Vector* matrix_velocity) {
  equations_.evaluate_motion(velocity, acceleration, damping_matrix, forces_, matrix_velocity);
}

void Newton::rest() { forces_.inertia = forces_.damping = Vector::Zero(equations_.size()); }

bool Newton::exploded(const IncrementResult& result) const {
  const std::vector<double>& norms = result.residuals;
  // Full steps are tried first, and given up early.
  return norms.back() > 1e12 * (norms.front() + result.early_scale) ||
         (!searching_ && norms.back() > 1e8 * std::max(norms[0], norms[1]));
}

Stop Newton::verdict(const Increment& increment, IncrementResult& result) {
  const Stop state = state_verdict();
  if (state != Stop::converged) return state;
  if (increment.motion.dynamic() || equations_.small_strain() || model_.settings.newton_iterations == 1 || rigid_free_)
    return Stop::converged;
  const bool far = result.residuals.size() <= 2 || definite_taken_;
  if ((far || indefinite_) && want_ == Want::tangent) {
    // The last factorisation of the exact tangent may be of a state far from this one.
    evaluate(increment, result.u, want_, true);
    const Stopwatch watch(seconds_linear_);
    LinearStatus status = factor(increment);
    if (status == LinearStatus::done) status = linear_->probe();
    indefinite_ = indefinite(status);
    // Loads that follow need not be the gradient of anything: what is left to look at is the determinant.
    if (indefinite_ && followers_ && factor_whole(increment) == LinearStatus::done) indefinite_ = unstable_whole();
  }
  return indefinite_ ? Stop::indefinite_tangent : Stop::converged;
}

void Newton::take_jump(const Increment& increment, const Vector& jump, const Vector& step, Vector& u) {
  const Vector start = u;
  u = start + jump + step;
  evaluate(increment, u, want_, false);
  if (!searching_ || !energetic_ || (forces_.found.finite && forces_.found.smallest_J > 0)) return;
  // The tangent of the start may be worth nothing where the supports go: the better of both guesses is gone on from.
  const bool finite = forces_.found.finite;
  const double energy = forces_.found.energy;
  evaluate(increment, start + jump, want_, false);
  if (forces_.found.finite && (!finite || forces_.found.energy < energy))
    u = start + jump;
  else
    evaluate(increment, u, want_, false);
}

IncrementResult Newton::begin(const Increment& increment, const Vector& jump) {
  IncrementResult result;
  Vector& u = result.u = increment.start;
  if (increment.near && fits(increment.motion))
    pulse();
  else if (tangent_current_ && springs_in_tangent_ == springs_of(increment.loads))
    equations_.evaluate_loads(u, increment.loads, forces_, followers_.get());
  else
    prepare(u, increment.loads);
  indefinite_ = definite_taken_ = insist_definite_ = false;
  round_off_ = last_step_ = 0;
  last_ = {}, exact_ = false;
  start_energy_ = forces_.found.energy;
  // Fixed unknowns move in the first iteration: their motion counts fully, their strain through the tangent.
  equations_.evaluate_motion(increment.motion.velocity_at(u + jump), increment.motion.acceleration_at(u + jump),
                             increment.damping_matrix, forces_);
  note_residual(increment, free_residual(increment), result);
  return result;
}

IncrementResult Newton::run(const Increment& increment) {
  const int limit = model_.settings.newton_iterations;
  Vector jump = Vector::Zero(increment.start.size()), step;
  for (Eigen::Index k = 0; k < jump.size(); ++k)
    if (increment.fixed[static_cast<std::size_t>(k)]) jump[k] = increment.target[k] - increment.start[k];
  const bool moved = jump.squaredNorm() > 0;
  IncrementResult result = begin(increment, jump);
  Vector& u = result.u;
  if (!std::isfinite(result.residuals.back())) return result.stop = not_finite(), result;
  Vector residual = free_residual(increment);
  if (!moved && limit > 1 && accepted(increment, residual, result))
    return result.stop = verdict(increment, result), result;
  linear_->expect(increment.expected);
  const bool again = increment.near && fits(increment.motion);
  for (int iteration = 0; iteration < limit; ++iteration) {
    if (iteration > 0) evaluate(increment, u, want_, true);
    ++iterations_;
    const bool moving = iteration == 0 && moved, exact = iteration > 0 || !again;
    definite_taken_ = false;
    const LinearStatus status = exact ? direction(increment, u, moving ? jump : Vector(), residual, step)
                                      : solve_again(increment, residual, linear_tolerance(increment, residual), step);
    if (status != LinearStatus::done) return result.stop = stop_of(status), result;
    result.definite += definite_taken_;
    tangent_current_ = insist_definite_ = false;
    if (limit == 1) return u += jump + step, result;
    round_off_ = round_off(u + jump * moving + step);
    double share = 1;
    if (moving)
      take_jump(increment, jump, step, u);
    else
      share = line_search(increment, step, residual, u);
    result.stunted += share < 0.125;
    if (share == 0) {
      if (definite_taken_ || !energetic_) return result.stop = Stop::diverged, result;
      insist_definite_ = true;
      evaluate(increment, u, want_, false);
    }
    last_step_ = definite_taken_ || !exact ? std::numeric_limits<double>::infinity() : step.cwiseAbs().maxCoeff();
    last_ = size_of(moving ? Vector(u - increment.start) : Vector(share * step), residual);
    exact_ = exact && share == 1 && !definite_taken_ && !moving;
    residual = free_residual(increment);
    note_residual(increment, residual, result);
    if (accepted(increment, residual, result)) return result.stop = verdict(increment, result), result;
    if (!residual.allFinite()) return result.stop = not_finite(), result;
    if (exploded(result)) return result.stop = Stop::diverged, result;
  }
  result.stop = Stop::newton_limit;
  return result;
}

}  // namespace msml::fe
