// SPDX-License-Identifier: GPL-3.0-or-later
// How far an increment has come: norms, scales, verdicts and statistics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/newton.hpp"
#include "solver/pieces.hpp"

namespace msml::fe {

double free_norm(const Vector& v, const Mask& fixed) {
  return std::sqrt(sum_pieces(v.size(), [&](long first, long last) {
    double sum = 0;
    for (long k = first; k < last; ++k)
      if (!fixed[static_cast<std::size_t>(k)]) sum += v[k] * v[k];
    return sum;
  }));
}

double Newton::finest(const Vector& u) const {
  // Displacements carry one part in 1e16, strains of a finite-strain law one part in 1e16 of 1.
  const Eigen::RowVector3d& extent = extent_;
  const Numbering& numbering = equations_.numbering();
  double volume = 1.0 / factored_->pattern->nodes();
  for (int c = 0; c < numbering.components; ++c) volume *= extent[c];
  const bool exact = equations_.small_strain() || numbering.scalar;
  const double size = exact ? 0 : std::pow(volume, 1.0 / numbering.components);
  return 4e-16 * (size + u.cwiseAbs().maxCoeff());
}

double Newton::round_off(const Vector& u) const {
  const std::vector<int>& diagonal = factored_->pattern->diagonal;
  const double sum = sum_pieces(static_cast<long>(diagonal.size()), [&](long first, long last) {
    double part = 0;
    for (long n = first; n < last; ++n)
      for (std::size_t i = 0; i < 3; ++i) {
        const double k = factored_->values[9 * static_cast<std::size_t>(diagonal[static_cast<std::size_t>(n)]) + 4 * i];
        part += k * k;
      }
    return part;
  });
  return std::sqrt(sum) * finest(u);
}

void Newton::note_residual(const Increment& increment, const Vector& residual, IncrementResult& result) const {
  const auto norm_of = [](const Vector& v) { return std::sqrt(dot(v, v)); };
  const double norm = free_norm(residual, increment.fixed), total = norm_of(residual);
  result.residuals.push_back(norm);
  const double reactions = std::sqrt(std::max(0.0, total * total - norm * norm));
  result.scale = std::max({norm_of(forces_.external), norm_of(forces_.internal), norm_of(forces_.inertia), reactions});
  result.largest_scale = std::max({result.largest_scale, result.scale, increment.met});
  if (result.residuals.size() <= 2) result.early_scale = result.largest_scale;
  result.worst_element = forces_.found.smallest_J_element;
  result.worst_J = forces_.found.smallest_J;
  double worst = -1;
  for (Eigen::Index k = 0; k < residual.size(); ++k)
    if (!increment.fixed[static_cast<std::size_t>(k)] && std::abs(residual[k]) > worst) {
      worst = std::abs(residual[k]);
      const Numbering& numbering = equations_.numbering();
      const int node = static_cast<int>(k / 3), extra = node - numbering.body_nodes();
      result.worst_node = extra < 0 ? numbering.node_of[static_cast<std::size_t>(node)]
                                    : numbering.pressure_of[static_cast<std::size_t>(extra)];
    }
}

Stop Newton::state_verdict() const {
  const Assembled& found = forces_.found;
  const Stop sound = found.finite ? Stop::converged : Stop::diverged;
  if (equations_.small_strain() || model_.settings.allow_inverted || found.smallest_J_element < 0) return sound;
  if (!survives_[static_cast<std::size_t>(found.smallest_J_element)])
    return found.smallest_J <= 0 ? Stop::inverted_element : sound;
  if (!found.finite) return Stop::diverged;
  // Motion may pass through inversion; an equilibrium there is a trap. F = 0 comes with det F of either sign.
  constexpr double flat = 1e-9;
  const bool trapped = !is_dynamic(model_.settings.integrator) && found.smallest_J <= flat;
  return trapped ? Stop::collapsed : Stop::converged;
}

Stop Newton::not_finite() const {
  return state_verdict() == Stop::inverted_element ? Stop::inverted_element : Stop::diverged;
}

void Newton::report(Outcome& outcome) const {
  outcome.newton_iterations = iterations_;
  outcome.linear_solves = solves_;
  outcome.cg_iterations = linear_->iterations;
  outcome.cg_gave_up = linear_->gave_up;
  if (definite_ > 0 && model_.settings.definiteness == Definiteness::automatic)
    outcome.recoveries.push_back(
        fmt::format("{} iterations took the law's semidefinite tangent, where its own was indefinite", definite_));
  if (walked_ > 0)
    outcome.recoveries.push_back(
        fmt::format("{} increments were reached in pieces, where Newton's method did not get there at once", walked_));
  if (linear_->gave_up)
    outcome.recoveries.emplace_back("conjugate gradients missed their tolerance, and a factorisation took over");
  outcome.seconds_assembly = seconds_assembly_;
  outcome.seconds_linear = seconds_linear_;
  const std::size_t values =
      tangent_.values.size() + effective_.values.size() + (followers_ ? followers_->values.size() : 0);
  outcome.held.push_back({"matrix", values * sizeof(double) + tangent_.pattern->bytes()});
  outcome.held.push_back({"factor", linear_->factor_bytes() + (unsymmetric_ ? unsymmetric_->factor_bytes() : 0)});
}

}  // namespace msml::fe
