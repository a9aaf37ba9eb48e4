// SPDX-License-Identifier: GPL-3.0-or-later
// When an increment has converged: residual, increment and energy, each beside a physical scale; see Newton.
#include <algorithm>
#include <cmath>

#include "solver/newton.hpp"

namespace msml::fe {
namespace {

constexpr double spread = 4;  // of round-off at single unknowns about that of all

double share_of(double part, double whole) {
  return part > 0 ? part / whole : 0;  // infinite where there is no scale
}

}  // namespace

Newton::Size Newton::size_of(const Vector& step, const Vector& residual) const {
  const Eigen::Index body = 3 * static_cast<Eigen::Index>(equations_.numbering().body_nodes());
  const Eigen::Index pressures = step.size() - body;
  const double by_pressures = step.tail(pressures).dot(residual.tail(pressures));
  // A saddle: what displacements and pressures lack must not cancel.
  return {step.head(body).cwiseAbs().maxCoeff(), std::abs(dot(step, residual) - by_pressures) + std::abs(by_pressures)};
}

Newton::Size Newton::scale(const Increment& increment, const Vector& u) const {
  const Eigen::Index body = 3 * static_cast<Eigen::Index>(equations_.numbering().body_nodes());
  const Vector gone = u - increment.start;
  Size scale{std::max(increment.start.head(body).cwiseAbs().maxCoeff(), u.head(body).cwiseAbs().maxCoeff()),
             std::max(std::abs(start_energy_), std::abs(forces_.found.energy))};
  for (const Vector* force : {&forces_.external, &forces_.internal, &forces_.inertia, &forces_.damping})
    scale.energy = std::max(scale.energy, std::abs(dot(gone, *force)));
  return scale;
}

bool is_round_off(const Vector& residual, const BlockMatrix& K, const Mask& fixed, double fine) {
  for (Eigen::Index k = 0; k < residual.size(); ++k) {
    if (fixed[static_cast<std::size_t>(k)]) continue;
    const double* block = K.values.data() + 9 * K.pattern->diagonal[static_cast<std::size_t>(k / 3)];
    if (std::abs(residual[k]) > spread * fine * std::max({block[0], block[4], block[8]})) return false;
  }
  return true;
}

bool Newton::at_round_off(const Vector& residual, const Mask& fixed, const Vector& u) const {
  if (equations_.numbering().mixed()) return free_norm(residual, fixed) <= round_off_;
  return round_off_ > 0 && is_round_off(residual, *factored_, fixed, finest(u));
}

bool Newton::complete(const Increment& increment, const Vector& residual, IncrementResult& result) {
  const bool first = result.residuals.size() == 1;
  // What the one solution of a linear problem leaves is the linear solver's.
  if (!first && equations_.small_strain() && !followers_) return true;
  const double tolerance = model_.settings.tolerance, fine = finest(result.u);
  if (at_round_off(residual, increment.fixed, result.u)) return true;
  const Size scale = this->scale(increment, result.u);
  const auto enough = [&](const Size& missing) {
    return missing.way <= std::max(tolerance * scale.way, fine) &&
           missing.energy <= std::max(tolerance * tolerance * scale.energy, fine * round_off_);
  };
  // Quadratic convergence leaves far less than the tolerance where the last step was of the size of its root.
  const double small = 0.1 * std::sqrt(tolerance);
  if (exact_ && last_.way <= small * scale.way && last_.energy <= small * small * scale.energy) return true;
  Vector step;
  if (!correction(increment, residual, step)) return false;
  Size missing = size_of(step, residual);
  // Steps by the same matrix would go on as a geometric series; where they do not shrink, by an unknown amount.
  const double left = last_.way > 0 ? std::max(0.1, 1 - missing.way / last_.way) : 1;
  missing.way /= left, missing.energy /= left;
  result.missing_way = share_of(missing.way, scale.way);
  result.missing_energy = std::sqrt(share_of(missing.energy, scale.energy));
  return enough(missing);
}

bool Newton::accepted(const Increment& increment, const Vector& residual, IncrementResult& result) {
  const double norm = result.residuals.back(), tolerance = model_.settings.tolerance;
  result.missing_way = result.missing_energy = -1;
  if (!std::isfinite(norm) || !std::isfinite(result.scale)) return false;
  if (norm == 0) return true;
  // More iterations do not help where round-off of the largest forces met is all that is left.
  const std::size_t count = result.residuals.size();
  if (count >= 3 && norm <= 1e-12 * result.largest_scale && norm > 0.5 * result.residuals[count - 2]) return true;
  if (norm <= tolerance * result.scale) return complete(increment, residual, result);
  if (at_round_off(residual, increment.fixed, result.u)) return true;
  // Where all forces vanish in the end they are no scale: an exact Newton step that is tiny beside the way gone is the
  // last one, however much of it the line search took where round-off hides the energy.
  if (last_step_ == 0 || count < 3) return false;
  const double way = std::max(increment.start.cwiseAbs().maxCoeff(), result.u.cwiseAbs().maxCoeff());
  return last_step_ <= 0.01 * tolerance * way && norm <= tolerance * result.largest_scale;
}

}  // namespace msml::fe
