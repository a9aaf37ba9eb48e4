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

double free_norm(const Vector& v, const Mask& fixed) {
  double sum = 0;
  for (Eigen::Index k = 0; k < v.size(); ++k)
    if (!fixed[static_cast<std::size_t>(k)]) sum += v[k] * v[k];
  return std::sqrt(sum);
}

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

double Newton::round_off(const Vector& u) const {
  // Displacements carry one part in 1e16, strains of a finite-strain law one part in 1e16 of 1: times the stiffness.
  const Points& points = model_.mesh->points;
  const Eigen::RowVector3d extent = points.colwise().maxCoeff() - points.colwise().minCoeff();
  const double size = equations_.small_strain() ? 0 : std::cbrt(extent.prod() / effective_.pattern->nodes());
  double sum = 0;
  for (const int p : effective_.pattern->diagonal)
    for (int i = 0; i < 3; ++i) {
      const double k = effective_.values[9 * static_cast<std::size_t>(p) + 4 * static_cast<std::size_t>(i)];
      sum += k * k;
    }
  return 4e-16 * std::sqrt(sum) * (size + u.cwiseAbs().maxCoeff());
}

void Newton::stiffness(const Vector& u, BlockMatrix& K) {
  const Stopwatch watch(seconds_assembly_);
  Forces unused;
  equations_.evaluate(u, {}, Want::definite_tangent, unused, &K);
}

Vector Newton::residual(const Increment& increment) const {
  if (increment.allowed.size() == 0) return forces_.residual();
  return forces_.residual() - increment.allowed;
}

LinearStatus Newton::factor(const Increment& increment) {
  const Kinematics& motion = increment.motion;
  const Settings& settings = model_.settings;
  effective_.values = tangent_.values;
  if (motion.dynamic()) {
    add(effective_, motion.acceleration_factor + motion.velocity_factor * settings.damping_mass, equations_.mass());
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
      Vector right = residual, product;
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

double Newton::line_search(const Increment& increment, const Vector& direction, const Vector& residual, Vector& u) {
  const Vector start = u;
  const double norm = free_norm(residual, increment.fixed), slope = dot(direction, residual);
  double step = 1;
  for (int trial = 0; trial < 12; ++trial) {
    u = start + step * direction;
    evaluate(increment, u, want_, false);
    const Vector now = this->residual(increment);
    const double new_norm = free_norm(now, increment.fixed);
    const double new_slope = dot(direction, now);
    if (!forces_.found.finite || !std::isfinite(new_norm)) {
      step *= 0.25;
      continue;
    }
    // Either the residual shrinks, or the minimum along the direction is not overshot by much. A follower pressure has
    // no energy to search, and in slender bodies the residual grows before it falls.
    if (!searching_ || followers_ || new_norm <= norm || new_slope >= -0.8 * std::abs(slope)) return step;
    step *= std::clamp(slope / (slope - new_slope), 0.1, 0.6);
  }
  return forces_.found.finite ? step : 0;
}

void Newton::note_residual(const Increment& increment, const Vector& residual, IncrementResult& result) const {
  const double norm = free_norm(residual, increment.fixed), total = residual.norm();
  result.residuals.push_back(norm);
  const double reactions = std::sqrt(std::max(0.0, total * total - norm * norm));
  result.scale = std::max({forces_.external.norm(), forces_.internal.norm(), forces_.inertia.norm(), reactions});
  result.worst_element = forces_.found.smallest_J_element;
  result.worst_J = forces_.found.smallest_J;
  double worst = -1;
  for (Eigen::Index k = 0; k < residual.size(); ++k)
    if (!increment.fixed[static_cast<std::size_t>(k)] && std::abs(residual[k]) > worst) {
      worst = std::abs(residual[k]);
      result.worst_node = equations_.numbering().node_of[static_cast<std::size_t>(k / 3)];
    }
}

bool Newton::accepted(const IncrementResult& result) const {
  const double norm = result.residuals.back();
  return std::isfinite(norm) && std::isfinite(result.scale) &&
         norm <= std::max(model_.settings.tolerance * result.scale, round_off_);
}

void Newton::move(const Vector& velocity, const Vector& acceleration, const BlockMatrix* damping_matrix) {
  equations_.evaluate_motion(velocity, acceleration, damping_matrix, forces_);
}

void Newton::rest() { forces_.inertia = forces_.damping = Vector::Zero(equations_.size()); }

Stop Newton::state_verdict() const {
  if (!forces_.found.finite) return Stop::diverged;
  if (!equations_.small_strain() && forces_.found.smallest_J <= 0 && !model_.settings.allow_inverted)
    return Stop::inverted_element;
  return Stop::converged;
}

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
  if (!tangent_current_) prepare(u, increment.loads);
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

IncrementResult Newton::walk(const Increment& increment) {
  const auto final = [this](const IncrementResult& result) {
    return result.stop == Stop::converged || result.stop == Stop::singular || result.stop == Stop::out_of_memory ||
           model_.settings.newton_iterations == 1;
  };
  searching_ = false;
  IncrementResult direct = run(increment);
  searching_ = model_.settings.line_search;
  if (!final(direct) && searching_) {
    tangent_current_ = false;
    direct = run(increment);
  }
  if (final(direct)) return direct;
  evaluate(increment, increment.start, want_, false);
  const Vector unbalanced = this->residual(increment);
  Increment part = increment;
  double share = 0, piece = 0.25;
  IncrementResult result = direct;
  while (share < 1 && piece > 1e-3) {
    const double next = std::min(1.0, share + piece);
    part.target = increment.start + next * (increment.target - increment.start);
    part.allowed = (1 - next) * unbalanced;
    tangent_current_ = false;
    result = run(part);
    if (result.stop == Stop::converged) {
      part.start = result.u;
      share = next;
      piece *= 2;
    } else {
      piece /= 2;
    }
  }
  tangent_current_ = false;
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

void Newton::report(Outcome& outcome) const {
  outcome.newton_iterations = iterations_;
  outcome.linear_solves = solves_;
  outcome.cg_iterations = linear_->iterations;
  outcome.cg_gave_up = linear_->gave_up;
  outcome.seconds_assembly = seconds_assembly_;
  outcome.seconds_linear = seconds_linear_;
  outcome.matrix_bytes = (tangent_.values.size() + effective_.values.size()) * sizeof(double) +
                         tangent_.pattern->columns.size() * sizeof(int);
  outcome.factor_bytes = linear_->factor_bytes();
}

}  // namespace msml::fe
