// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens Newton steps that do not descend.
#include <algorithm>
#include <cmath>

#include "solver/newton.hpp"

namespace msml::fe {
namespace {

/// The energy along a direction: elastic energy, minus work of dead loads, plus the potential of inertia and damping
/// forces, which are linear in the displacement. Its derivative is minus the residual.
class EnergyAlong {
 public:
  EnergyAlong(const Increment& increment, const Forces& start, const Vector& direction)
      : force_share_(increment.motion.force_share),
        inertia_share_(increment.motion.inertia_share),
        start_energy_(start.found.energy),
        direction_(direction) {
    constant_ = force_share_ * dot(direction, start.external);
    if (increment.offset.size() > 0) constant_ -= dot(direction, increment.offset);
    start_motion_ = motion(start);
  }
  /// Change of energy at a share of the direction.
  double change(double share, const Forces& now) const {
    return force_share_ * (now.found.energy - start_energy_) +
           share * (0.5 * (start_motion_ + motion(now)) - constant_);
  }
  /// What round-off in the energies alone can change.
  double noise(double share, const Forces& now) const {
    const double parts = std::abs(start_energy_) + std::abs(now.found.energy) +
                         std::abs(share) * (std::abs(constant_) + std::abs(start_motion_) + std::abs(motion(now)));
    return 1e-13 * parts;
  }

 private:
  double motion(const Forces& f) const {
    return force_share_ * dot(direction_, f.damping) + inertia_share_ * dot(direction_, f.inertia);
  }
  double force_share_, inertia_share_, start_energy_, constant_ = 0, start_motion_ = 0;
  const Vector& direction_;
};

}  // namespace

double Newton::residual_search(const Increment& increment, const Vector& direction, const Vector& residual, Vector& u) {
  const Vector start = u;
  const double norm = free_norm(residual, increment.fixed);
  const bool guarded = barrier_ && searching_ && forces_.found.smallest_J > 0 && !model_.settings.allow_inverted;
  const Eigen::Index moved = 3 * equations_.numbering().body_nodes();
  const double slope = direction.head(moved).dot(residual.head(moved));
  double step = 1;
  for (int trial = 0; trial < 10; ++trial, step *= 0.5) {
    u = start + step * direction;
    evaluate(increment, u, want_, false);
    const Vector left = free_residual(increment);
    const double now = free_norm(left, increment.fixed);
    if (guarded && forces_.found.smallest_J <= 0) continue;
    if (!forces_.found.finite || !std::isfinite(now)) continue;
    if (!searching_ || now <= (1 - 1e-4 * step) * norm) return step;
    // A slender body that turns is stretched on the way, and its residual grows. With the pressures eliminated this is
    // the slope of its energy along the step: near a minimum of that it is small.
    const double new_slope = direction.head(moved).dot(left.head(moved));
    if (slope > 0 && std::abs(new_slope) <= 0.8 * slope) return step;
  }
  return forces_.found.finite ? step : 0;
}

double Newton::line_search(const Increment& increment, const Vector& direction, const Vector& residual, Vector& u) {
  if (equations_.numbering().mixed()) return residual_search(increment, direction, residual, u);
  const Vector start = u;
  const double norm = free_norm(residual, increment.fixed), slope = dot(direction, residual);
  const EnergyAlong energy(increment, forces_, direction);
  const bool guarded = barrier_ && searching_ && forces_.found.smallest_J > 0 && !model_.settings.allow_inverted;
  double step = 1;
  for (int trial = 0; trial < 25; ++trial) {
    u = start + step * direction;
    evaluate(increment, u, want_, false);
    const Vector now = free_residual(increment);
    const double new_norm = free_norm(now, increment.fixed), new_slope = dot(direction, now);
    const bool sound = forces_.found.finite && std::isfinite(new_norm) && std::isfinite(new_slope);
    if (!sound || (guarded && forces_.found.smallest_J <= 0)) {
      step *= sound ? 0.5 : 0.25;
      continue;
    }
    if (!searching_) return step;
    if (energetic_) {
      // Armijo's rule; where round-off hides the change, the residual decides.
      const double change = energy.change(step, forces_);
      if (change <= -1e-4 * step * slope) return step;
      if (std::abs(change) <= energy.noise(step, forces_) && new_norm <= 1.1 * norm) return step;
      const double bent = change + step * slope;  // 0 for a straight line
      step *= bent > 0 ? std::clamp(0.5 * step * slope / bent, 0.1, 0.6) : 0.5;
      continue;
    }
    // Either the residual shrinks, or the minimum along the direction is not overshot by much. A follower pressure has
    // no energy to search, and in slender bodies the residual grows before it falls.
    if (followers_ || new_norm <= norm || new_slope >= -0.8 * std::abs(slope)) return step;
    step *= std::clamp(slope / (slope - new_slope), 0.1, 0.6);
    if (trial >= 11) return step;
  }
  u = start;
  return 0;
}

}  // namespace msml::fe
