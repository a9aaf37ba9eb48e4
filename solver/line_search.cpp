// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens Newton steps that do not descend.
#include <algorithm>
#include <cmath>

#include "solver/newton.hpp"

namespace msml::fe {

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

}  // namespace msml::fe
