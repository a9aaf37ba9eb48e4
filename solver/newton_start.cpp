// SPDX-License-Identifier: GPL-3.0-or-later
// What a run begins with: pressures, accelerations, and motions that keep volumes.
#include <algorithm>
#include <cmath>

#include "solver/kept_volume.hpp"
#include "solver/newton.hpp"

namespace msml::fe {
namespace {

/// The largest entry at displacements; pressures are no motion.
double largest(const Numbering& numbering, const Vector& motion) {
  return motion.head(3 * numbering.body_nodes()).cwiseAbs().maxCoeff();
}

constexpr int most_rounds = 10;   // of Newton's method on c(u) = 0, which converges in three
constexpr double unseen = 1e-12;  // of displacements, beside the largest

/// Rows of open pressures become the opposite of `rates`.
void take_rows(const Vector& rates, const Mask& open, Vector& right) {
  for (std::size_t k = 0; k < open.size(); ++k)
    if (open[k]) right[static_cast<Eigen::Index>(k)] = -rates[static_cast<Eigen::Index>(k)];
}

/// True if both is a solution.
bool solved(LinearStatus factored, Saddle& saddle, const Vector& right, const Vector& given, Vector& both) {
  return factored == LinearStatus::done && saddle.solve(right, given, both) == LinearStatus::done && both.allFinite();
}

/// What M a = force adds to the given accelerations of fixed unknowns; `mass` is overwritten.
Vector without_pressures(const Equations& equations, Vector force, const Vector& given, const Supports& supports,
                         BlockMatrix& mass) {
  Vector moved, a = Vector::Zero(force.size());
  multiply(equations.mass(), given, moved);
  force -= moved;
  mass.set_zero();
  add(mass, 1, equations.mass());
  const auto solver = make_conjugate_gradient(Preconditioner::jacobi);
  supports.slides.project(mass);
  supports.slides.project(force);
  Mask still = pressure_mask(equations.numbering(), true);
  for (std::size_t k = 0; k < still.size(); ++k) still[k] = still[k] || supports.fixed[k];
  if (solver->factor(mass, still) == LinearStatus::done) solver->solve(force, 1e-13, a);
  return a;
}

}  // namespace

int Newton::settle_pressures(Vector& u) {
  const Numbering& numbering = equations_.numbering();
  if (!numbering.mixed()) return 0;
  factor_known_ = false;
  prepare(u, {});
  if (!forces_.internal.allFinite()) return 0;
  BlockMatrix& compliance = effective_;  // which no increment uses yet
  compliance.values = tangent_.values;
  for (double& value : compliance.values) value = -value;
  Mask still = pressure_mask(numbering, false);
  std::fill_n(still.begin(), 3 * numbering.body_nodes(), 1);
  const Mask open = open_pressures(numbering, tangent_);
  for (std::size_t k = 0; k < open.size(); ++k) still[k] = still[k] || open[k];
  // As well conditioned as a mass matrix.
  const auto solver = make_conjugate_gradient(Preconditioner::jacobi);
  Vector change = Vector::Zero(u.size());
  if (solver->factor(compliance, still) == LinearStatus::done) solver->solve(forces_.internal, 1e-13, change);
  u += change;
  return static_cast<int>(std::ranges::count(open, 1));
}

Vector Newton::initial_acceleration(Vector& u, const Vector& v, const ScaledLoads& loads, const Supports& supports,
                                    const Vector& given, bool& balanced) {
  factor_known_ = false;
  prepare(u, loads);
  BlockMatrix C(tangent_.pattern, 0);
  const bool damped = damping(u, loads, C);
  equations_.evaluate_motion(v, Vector::Zero(u.size()), damped ? &C : nullptr, forces_);
  Vector force = forces_.residual(), a = given, both;
  const Mask open = open_pressures(equations_.numbering(), tangent_);
  const bool keeps = std::ranges::count(open, 1) > 0 && force.allFinite();
  balanced = true;
  if (keeps) {
    take_rows(second_rate(equations_.elements(), u, v), open, force);
    Saddle saddle(equations_, supports, open, *linear_, effective_);
    balanced = solved(saddle.factor(tangent_), saddle, force, given, both);
  }
  if (keeps && balanced) {
    const Eigen::Index body = 3 * static_cast<Eigen::Index>(equations_.numbering().body_nodes());
    a.head(body) = both.head(body);
    u.tail(u.size() - body) += both.tail(u.size() - body);
    prepare(u, loads);
  } else {
    a += without_pressures(equations_, force, given, supports, effective_);
  }
  Numbers<double>().swap(effective_.values);  // time steps need not have this room
  multiply(equations_.mass(), a, forces_.inertia);
  return a;
}

Newton::Kept Newton::keep_volumes(Vector& u, Vector& v, Vector before, const Supports& supports) {
  const Numbering& numbering = equations_.numbering();
  if (!numbering.mixed() || (largest(numbering, u) == 0 && v.isZero(0))) return {};
  factor_known_ = false;
  prepare(u, {});
  const Mask open = open_pressures(numbering, tangent_);
  if (std::ranges::count(open, 1) == 0 || !forces_.internal.allFinite()) return {};
  Saddle saddle(equations_, supports, open, *linear_, effective_);
  const Vector zero = Vector::Zero(u.size());
  /// Adds the smallest motion that takes `rows` of c or its rate away; its size, infinite where there is none.
  const auto correct = [&](const Vector& rows, const Vector& given, Vector& motion) {
    Vector right = zero, both;
    take_rows(rows, open, right);
    if (!solved(saddle.factor(tangent_), saddle, right, given, both)) return std::numeric_limits<double>::infinity();
    both.tail(both.size() - 3 * numbering.body_nodes()).setZero();
    motion += both;
    return largest(numbering, both);
  };
  Vector placed = u, rates, jump = zero;
  double change = largest(numbering, u) > 0 ? 1 : 0;
  for (int round = 0; round < most_rounds && change > unseen * largest(numbering, placed); ++round) {
    change = correct(forces_.internal, zero, placed);
    if (!std::isfinite(change)) return {.done = false};
    prepare(placed, {});
    if (!forces_.internal.allFinite()) return {.done = false};
  }
  if (change > 1e-9 * largest(numbering, placed)) return {.done = false};
  supports.slides.project(before);
  for (std::size_t k = 0; k < supports.fixed.size(); ++k)
    if (const auto i = static_cast<Eigen::Index>(k); supports.fixed[k]) jump[i] = v[i] - before[i];
  multiply(tangent_, before, rates);
  if (!v.isZero(0) && !std::isfinite(correct(rates, jump, before))) return {.done = false};
  const auto share = [&](const Vector& first, const Vector& last) {
    const double size = std::max(largest(numbering, first), largest(numbering, last));
    return size > 0 ? largest(numbering, last - first) / size : 0;
  };
  const Kept kept{.displacement = share(u, placed), .velocity = share(v, before)};
  u = placed;
  v = before;
  return kept;
}

}  // namespace msml::fe
