// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems of Newton's method.
#include <algorithm>
#include <utility>

#include "solver/linear/gmres.hpp"
#include "solver/newton.hpp"
#include "solver/stopwatch.hpp"

namespace msml::fe {
namespace {

constexpr double shift = 1e-8;  // far above round-off, far below the softest motion that strains the body

void shift_diagonal(BlockMatrix& A) {
  for (const int p : A.pattern->diagonal)
    for (std::size_t i = 0; i < 3; ++i) A.values[9 * static_cast<std::size_t>(p) + 4 * i] *= 1 + shift;
}

/// Adds a thousandth of the mean diagonal to each diagonal entry.
void lift_diagonal(BlockMatrix& A) {
  double sum = 0;
  const auto entry = [&](int p, std::size_t i) -> double& { return A.values[9 * static_cast<std::size_t>(p) + 4 * i]; };
  for (const int p : A.pattern->diagonal)
    for (std::size_t i = 0; i < 3; ++i) sum += entry(p, i);
  const double lift = 1e-3 * sum / (3.0 * static_cast<double>(A.pattern->diagonal.size()));
  for (const int p : A.pattern->diagonal)
    for (std::size_t i = 0; i < 3; ++i) entry(p, i) += lift;
}

/// A x = b with `shifted` factorised instead of the singular A: refines while that helps.
LinearStatus solve_singular(const BlockMatrix& A, LinearSystem& shifted, const Mask& fixed, const Vector& b,
                            double tolerance, Vector& x) {
  Vector rest = b, correction, product;
  x = Vector::Zero(b.size());
  double before = free_norm(b, fixed);
  const double target = tolerance * before;
  for (int round = 0; round < 6; ++round) {
    const LinearStatus status = shifted.solve(rest, tolerance, correction);
    if (status != LinearStatus::done) return status;
    multiply(A, Vector(x + correction), product);
    const Vector left = b - product;
    const double now = free_norm(left, fixed);
    if (round > 0 && !(now < before)) break;
    x += correction;
    rest = left;
    before = now;
    if (now <= target) break;
  }
  return LinearStatus::done;
}

/// What an iterative solver leaves across planes, residuals do not show: it would grow from step to step.
void keep_in_planes(const Increment& increment, Vector& step) {
  if (increment.slides && step.size() > 0) increment.slides->project(step);
}

}  // namespace

BlockMatrix* Newton::place_of(Want want) {
  held_ = kept_ && want == Want::single_tangent;
  return held_ ? nullptr : &tangent_;
}

const BlockMatrix& Newton::tangent() {
  if (std::exchange(held_, false)) kept_->assemble(tangent_);
  return tangent_;
}

bool Newton::take_kept(const Increment& increment, double inertia) {
  products_.emplace(*kept_, inertia, equations_.mass(), tangent_);
  return linear_->take(*products_, increment.fixed);
}

LinearStatus Newton::factor(const Increment& increment, bool keep_tangent) {
  const Kinematics& motion = increment.motion;
  const Settings& settings = model_.settings;
  const bool slides = increment.slides && !increment.slides->empty();
  // Divided by force_share, so that the tangent is there as it is.
  const double inertia = motion.acceleration_factor * motion.inertia_share / motion.force_share +
                         motion.velocity_factor * settings.damping_mass;
  const bool plain = motion.dynamic() && !rigid_free_ && !lifted_ && !slides && !followers_;
  if (held_ && plain && take_kept(increment, inertia)) return LinearStatus::done;
  tangent();
  factored_ = &tangent_;
  if (!motion.dynamic() && !rigid_free_ && !lifted_ && !slides && !followers_)
    return linear_->factor(tangent_, increment.fixed);
  if (plain && !keep_tangent && !increment.damping_matrix) {
    add(tangent_, inertia, equations_.mass());
    tangent_current_ = false;
    return linear_->factor(tangent_, increment.fixed);
  }
  factored_ = &effective_;
  if (motion.dynamic()) {
    effective_.assign(tangent_, inertia, equations_.mass());
    if (increment.damping_matrix) add(effective_, motion.velocity_factor, *increment.damping_matrix);
  } else {
    effective_.assign(tangent_, 0, equations_.mass());
  }
  if (rigid_free_) shift_diagonal(effective_);
  if (lifted_) lift_diagonal(effective_);
  if (increment.slides) increment.slides->project(effective_);
  return linear_->factor(effective_, increment.fixed);
}

double Newton::linear_tolerance(const Increment& increment, const Vector& right) const {
  const double asked = model_.settings.linear_tolerance;
  const Mask& fixed = increment.fixed;
  if (equations_.small_strain() || !linear_->iterative()) return asked;
  const double scale = std::max(forces_.external.norm(), forces_.internal.norm());
  if (model_.settings.newton_iterations == 1) {
    constexpr double cancelled = 1e-9, rough = 0.5;  // of forces, of round-off
    const bool nothing =
        free_norm(right, fixed) <= cancelled * scale && is_round_off(right, *factored_, fixed, finest(increment.start));
    return nothing ? std::max(asked, rough) : asked;
  }
  return scale > 0 ? std::clamp(0.01 * free_norm(right, fixed) / scale, asked, 1e-3) : asked;
}

LinearStatus Newton::solve(const Increment& increment, const Vector& right, double tolerance, Vector& step) {
  if (rigid_free_ && !followers_ && !(increment.slides && !increment.slides->empty()))
    return solve_singular(tangent_, *linear_, increment.fixed, right, tolerance, step);
  if (!followers_) return linear_->solve(right, tolerance, step);
  Vector extra;
  const LinearMap whole = [&](const Vector& x, Vector& y) {
    pulse();
    multiply(effective_, x, y);
    multiply(*followers_, x, extra);
    if (increment.slides) increment.slides->project(extra);
    y += extra;
  };
  const LinearStatus status = solve_unsymmetric(whole, *linear_, increment.fixed, right, tolerance, step);
  if (status == LinearStatus::done || status == LinearStatus::out_of_memory) return status;
  // Far from the symmetric part, for instance where a pressure blows a thin wall up, only a factorisation of all helps.
  const LinearStatus factored = factor_whole(increment);
  return factored == LinearStatus::done ? unsymmetric_->solve(right, tolerance, step) : factored;
}

LinearStatus Newton::factor_whole(const Increment& increment) {
  if (!whole_) whole_ = std::make_unique<BlockMatrix>(effective_.pattern);
  whole_->values = effective_.values;
  add(*whole_, 1, *followers_);
  if (increment.slides) increment.slides->project(*whole_);
  if (!unsymmetric_) unsymmetric_ = make_unsymmetric(model_.settings.threads, model_.settings.pulse);
  return unsymmetric_->factor(*whole_, increment.fixed);
}

LinearStatus Newton::attempt(const Increment& increment, const Vector& jump, const Vector& residual, Vector& step) {
  const Stopwatch watch(seconds_linear_);
  pulse();
  // With one iteration a step nobody asks for the tangent again before the next one is made.
  const bool keep_tangent = model_.settings.newton_iterations > 1 || definite_taken_ || jump.size() > 0;
  LinearStatus status = factor(increment, keep_tangent);
  // A pressure that follows an open face makes the symmetric part indefinite long before anything buckles.
  whole_taken_ = followers_ && indefinite(status);
  if (whole_taken_) status = factor_whole(increment);
  if (status != LinearStatus::done) return status;
  pulse();
  Vector right = residual / increment.motion.force_share, product;
  if (jump.size() > 0) {
    if (held_)
      kept_->multiply(0, equations_.mass(), jump, product);
    else
      multiply(tangent_, jump, product);
    right -= product;
    if (followers_) {
      multiply(*followers_, jump, product);
      right -= product;
    }
  }
  if (increment.slides) increment.slides->project(right);
  ++solves_;
  const double tolerance = linear_tolerance(increment, right);
  status = whole_taken_ ? unsymmetric_->solve(right, tolerance, step) : solve(increment, right, tolerance, step);
  keep_in_planes(increment, step);
  factor_known_ = status == LinearStatus::done;
  factor_velocity_ = increment.motion.velocity_factor;
  factor_acceleration_ = increment.motion.acceleration_factor;
  return status;
}

bool Newton::fits(const Kinematics& motion) const {
  return factor_known_ && motion.velocity_factor == factor_velocity_ &&
         motion.acceleration_factor == factor_acceleration_;
}

LinearStatus Newton::solve_again(const Increment& increment, const Vector& residual, double tolerance, Vector& step) {
  const Stopwatch watch(seconds_linear_);
  Vector right = residual / increment.motion.force_share;
  if (increment.slides) increment.slides->project(right);
  ++solves_;
  const LinearStatus status =
      whole_taken_ ? unsymmetric_->solve(right, tolerance, step) : solve(increment, right, tolerance, step);
  keep_in_planes(increment, step);
  return status;
}

bool Newton::correction(const Increment& increment, const Vector& residual, Vector& step) {
  constexpr double rough = 0.1;  // one figure is enough to know how much is missing
  return fits(increment.motion) && solve_again(increment, residual, rough, step) == LinearStatus::done &&
         step.allFinite();
}

}  // namespace msml::fe
