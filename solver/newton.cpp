// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method with backtracking, for statics and for implicit time steps.
#include "solver/newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "solver/linear/gmres.hpp"

namespace msml::fe {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total) {}
  ~Stopwatch() { total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
      linear_(make_linear_system(model.settings, equations.size())),
      tangent_(equations.elements().pattern()),
      effective_(equations.elements().pattern()),
      want_(model.settings.newton_iterations == 1 ? Want::single_tangent : Want::tangent) {
  searching_ = model.settings.line_search;
  if (equations.has_followers()) followers_ = std::make_unique<BlockMatrix>(equations.elements().pattern());
}

void Newton::evaluate(const Increment& increment, const Vector& u, Want want, bool with_tangent) {
  const Stopwatch watch(seconds_assembly_);
  equations_.evaluate(u, increment.loads, want, forces_, with_tangent ? &tangent_ : nullptr,
                      with_tangent ? followers_.get() : nullptr);
  equations_.evaluate_motion(increment.motion.velocity_at(u), increment.motion.acceleration_at(u),
                             increment.damping_matrix, forces_);
}

void Newton::prepare(const Vector& u, const ScaledLoads& loads) {
  const Stopwatch watch(seconds_assembly_);
  equations_.evaluate(u, loads, want_, forces_, &tangent_, followers_.get());
  tangent_current_ = true;
}

void Newton::look(const Vector& u, const ScaledLoads& loads) {
  const Stopwatch watch(seconds_assembly_);
  equations_.evaluate(u, loads, Want::stress, forces_, nullptr);
  tangent_current_ = false;
}

void Newton::stiffness(const Vector& u, BlockMatrix& K) {
  const Stopwatch watch(seconds_assembly_);
  Forces unused;
  equations_.evaluate(u, {}, Want::definite_tangent, unused, &K);
}

Vector Newton::residual(const Increment& increment) const {
  const Kinematics& motion = increment.motion;
  Vector residual = motion.force_share * (forces_.external - forces_.internal - forces_.damping) -
                    motion.inertia_share * forces_.inertia;
  if (increment.offset.size() > 0) residual -= increment.offset;
  return residual;
}

LinearStatus Newton::factor(const Increment& increment) {
  const Kinematics& motion = increment.motion;
  const Settings& settings = model_.settings;
  effective_.values = tangent_.values;
  if (motion.dynamic()) {
    // Divided by force_share, so that the tangent is there as it is.
    const double inertia = motion.acceleration_factor * motion.inertia_share / motion.force_share;
    add(effective_, inertia + motion.velocity_factor * settings.damping_mass, equations_.mass());
    if (increment.damping_matrix)
      add(effective_, motion.velocity_factor * settings.damping_stiffness, *increment.damping_matrix);
  }
  return linear_->factor(effective_, increment.fixed);
}

LinearStatus Newton::solve(const Increment& increment, const Vector& right, Vector& step) {
  const double tolerance = model_.settings.linear_tolerance;
  if (!followers_) return linear_->solve(right, tolerance, step);
  Vector extra;
  const LinearMap whole = [&](const Vector& x, Vector& y) {
    multiply(effective_, x, y);
    multiply(*followers_, x, extra);
    y += extra;
  };
  const LinearStatus status = solve_unsymmetric(whole, *linear_, increment.fixed, right, tolerance, step);
  if (status == LinearStatus::done || status == LinearStatus::out_of_memory) return status;
  // Far from the symmetric part, for instance where a pressure blows a thin wall up, only a factorisation of all helps.
  BlockMatrix all = effective_;
  add(all, 1, *followers_);
  if (!unsymmetric_) unsymmetric_ = make_unsymmetric(model_.settings.threads);
  const LinearStatus factored = unsymmetric_->factor(all, increment.fixed);
  return factored == LinearStatus::done ? unsymmetric_->solve(right, tolerance, step) : factored;
}

LinearStatus Newton::direction(const Increment& increment, const Vector& u, const Vector& jump, const Vector& residual,
                               Vector& step) {
  for (const bool definite : {false, true}) {
    if (definite) {
      evaluate(increment, u, Want::definite_tangent, true);
      tangent_current_ = false;
    }
    const Stopwatch watch(seconds_linear_);
    LinearStatus status = factor(increment);
    if (status == LinearStatus::done) {
      Vector right = residual / increment.motion.force_share, product;
      if (jump.size() > 0) {
        multiply(tangent_, jump, product);
        right -= product;
        if (followers_) {
          multiply(*followers_, jump, product);
          right -= product;
        }
      }
      ++solves_;
      status = solve(increment, right, step);
    }
    // Conjugate gradients notice an indefinite matrix in the solve, a factorisation before it.
    if (!definite) indefinite_ = status == LinearStatus::not_positive_definite;
    if (status != LinearStatus::not_positive_definite) return status;
  }
  return LinearStatus::singular;  // a semidefinite matrix without a factorisation
}

void Newton::move(const Vector& velocity, const Vector& acceleration, const BlockMatrix* damping_matrix) {
  equations_.evaluate_motion(velocity, acceleration, damping_matrix, forces_);
}

void Newton::rest() { forces_.inertia = forces_.damping = Vector::Zero(equations_.size()); }

Stop Newton::verdict(const Increment& increment, IncrementResult& result) {
  const Stop state = state_verdict();
  if (state != Stop::converged) return state;
  if (increment.motion.dynamic() || equations_.small_strain() || model_.settings.newton_iterations == 1)
    return Stop::converged;
  if (result.residuals.size() <= 2 && want_ == Want::tangent && !indefinite_) {
    // The last factorisation may be of a state far from this one.
    evaluate(increment, result.u, want_, true);
    const Stopwatch watch(seconds_linear_);
    indefinite_ = linear_->factor(tangent_, increment.fixed) == LinearStatus::not_positive_definite;
  }
  return indefinite_ ? Stop::indefinite_tangent : Stop::converged;
}

IncrementResult Newton::run(const Increment& increment) {
  const int limit = model_.settings.newton_iterations;
  IncrementResult result;
  Vector& u = result.u = increment.start;
  Vector jump = Vector::Zero(u.size());
  for (Eigen::Index k = 0; k < u.size(); ++k)
    if (increment.fixed[static_cast<std::size_t>(k)]) jump[k] = increment.target[k] - u[k];
  if (tangent_current_)
    equations_.evaluate_loads(u, increment.loads, forces_, followers_.get());
  else
    prepare(u, increment.loads);
  indefinite_ = false;
  // Fixed unknowns move in the first iteration: their motion counts fully, their strain through the tangent.
  equations_.evaluate_motion(increment.motion.velocity_at(u + jump), increment.motion.acceleration_at(u + jump),
                             increment.damping_matrix, forces_);
  Vector residual = this->residual(increment), step;
  note_residual(increment, residual, result);
  if (!std::isfinite(result.residuals.back())) return result.stop = Stop::diverged, result;
  const bool moved = jump.squaredNorm() > 0;
  round_off_ = 0;
  if (!moved && limit > 1 && accepted(result)) {
    result.stop = verdict(increment, result);
    return result;
  }
  for (int iteration = 0; iteration < limit; ++iteration) {
    if (iteration > 0) evaluate(increment, u, want_, true);
    ++iterations_;
    const bool moving = iteration == 0 && moved;
    const LinearStatus status = direction(increment, u, moving ? jump : Vector(), residual, step);
    if (status != LinearStatus::done) return result.stop = stop_of(status), result;
    tangent_current_ = false;
    if (iteration == 0) round_off_ = round_off(u + jump + step);
    if (moving || limit == 1) {
      u += jump * (iteration == 0) + step;
      if (limit == 1) return result;
      evaluate(increment, u, want_, false);
    } else if (line_search(increment, step, residual, u) == 0) {
      return result.stop = Stop::diverged, result;
    }
    residual = this->residual(increment);
    note_residual(increment, residual, result);
    if (accepted(result)) return result.stop = verdict(increment, result), result;
    if (!residual.allFinite() || result.residuals.back() > 1e12 * (result.residuals.front() + result.scale))
      return result.stop = Stop::diverged, result;
  }
  result.stop = Stop::newton_limit;
  return result;
}

Vector Newton::initial_acceleration(const Vector& u, const Vector& v, const ScaledLoads& loads, const Mask& fixed) {
  prepare(u, loads);
  equations_.evaluate_motion(v, Vector::Zero(u.size()), &tangent_, forces_);
  BlockMatrix mass(tangent_.pattern);
  add(mass, 1, equations_.mass());
  const auto solver = make_conjugate_gradient(Preconditioner::jacobi);
  Vector a = Vector::Zero(u.size());
  if (solver->factor(mass, fixed) == LinearStatus::done) solver->solve(forces_.residual(), 1e-13, a);
  forces_.inertia.setZero();
  multiply(equations_.mass(), a, forces_.inertia);
  return a;
}

}  // namespace msml::fe
