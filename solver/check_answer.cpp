// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the answer of a run.
#include "solver/check_answer.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/conditions/springs.hpp"
#include "solver/measure.hpp"
#include "solver/unknowns.hpp"

namespace msml::fe {
namespace {

Vec3 sum(const Vector& v) {
  Vec3 total = Vec3::Zero();
  for (Eigen::Index k = 0; k < v.size(); k += 3) total += v.segment<3>(k);
  return total;
}

/// What springs do to the body: in internal forces they hide where nothing else holds it.
Vector spring_forces(const Run& run) {
  Vector forces = Vector::Zero(run.equations.size());
  const Equations& equations = run.equations;
  add_springs(equations.loads(run.now.step).springs, run.now.time, equations.positions(), run.now.u, false, forces,
              nullptr);
  return forces;
}

void check_balance(const Run& run, const Supports& supports, Check& check) {
  const Forces& f = run.between ? *run.between : run.newton.forces();
  Vector residual = f.residual(), reaction = run.now.reaction;
  if (run.between) {
    reaction = supports.slides.removed(residual);
    for (Eigen::Index k = 0; k < residual.size(); ++k)
      reaction[k] = -(supports.fixed[static_cast<std::size_t>(k)] ? residual[k] : reaction[k]);
  }
  supports.slides.project(residual);
  check.load_scale =
      std::max({f.external.norm(), f.internal.norm(), f.inertia.norm(), reaction.norm(), spring_forces(run).norm()});
  if (check.load_scale > 0) check.residual = free_norm(residual, supports.fixed) / check.load_scale;
  check.sum_loads = sum(f.external);
  check.sum_reactions = sum(reaction);
  // Springs to points in space hold from outside: what they give is all that internal forces sum to.
  if (!run.model.steps[static_cast<std::size_t>(run.now.step)].springs.empty()) check.sum_reactions -= sum(f.internal);
  check.sum_inertia = sum(f.inertia);
  check.sum_damping = sum(f.damping);
  // Where all of them vanish, as in a body pulled apart at both ends, they are judged beside the forces in the body.
  const double largest = std::max({check.sum_loads.norm(), check.sum_reactions.norm(), check.sum_inertia.norm(),
                                   check.sum_damping.norm(), 1e-6 * check.load_scale, 1e-300});
  check.balance = (check.sum_loads + check.sum_reactions - check.sum_inertia - check.sum_damping).norm() / largest;
}

void check_deformation(const Run& run, Check& check) {
  const Numbering& numbering = run.equations.numbering();
  std::vector<Deformation> elements(numbering.elements.size());
  run.equations.elements().visit_points(run.now.u, [&](std::size_t e, const ElementPoints& points) {
    elements[e] = deformation(points, numbering.scalar);
  });
  double volume = 0, deformed = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Deformation& d = elements[e];
    volume += d.volume;
    deformed += d.deformed_volume;
    check.largest_strain = std::max(check.largest_strain, d.largest_strain);
    check.largest_rotation = std::max(check.largest_rotation, d.largest_rotation);
    if (d.smallest_J < check.smallest_J) {
      check.smallest_J = d.smallest_J;
      check.smallest_J_element = numbering.elements[e];
    }
  }
  check.volume = volume;
  if (volume > 0) check.volume_change = (deformed - volume) / volume;
  check.mass = run.equations.total_mass();
}

/// A displacement linear in the position with coefficients of no symmetry: rich in the lowest mode of any body.
Vector smooth_start(const Vector& X, const Mask& fixed) {
  Vector x = Vector::Zero(X.size());
  const double size = X.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::Index n = k - k % 3, c = k % 3;
    if (!fixed[static_cast<std::size_t>(k)])
      x[k] = std::sqrt(2.0 + static_cast<double>(c)) +
             (X[n] + std::sqrt(3.0) * X[n + 1] + std::sqrt(7.0) * X[n + 2]) / size;
  }
  return x;
}

/// Lowest period of K x = w^2 M x by inverse iteration, to about 1e-3; 0 if K cannot be factorised (a body free to
/// move).
double lowest_period(Run& run, const Supports& supports) {
  LinearSystem& linear = run.newton.linear();
  std::unique_ptr<BlockMatrix> projected;
  if (!supports.slides.empty()) {
    projected = std::make_unique<BlockMatrix>(run.newton.tangent());
    supports.slides.project(*projected);
  }
  const BlockMatrix& K = projected ? *projected : run.newton.tangent();
  const ScalarMatrix& M = run.equations.mass();
  if (linear.factor(K, supports.fixed) != LinearStatus::done) return 0;
  Vector x = smooth_start(run.equations.positions(), supports.fixed), Mx, y;
  double square = 0;
  for (int iteration = 0; iteration < 15; ++iteration) {
    multiply(M, x, Mx);
    supports.slides.project(Mx);
    const double size = std::sqrt(dot(x, Mx));
    if (!(size > 0)) return 0;
    x /= size;
    Mx /= size;
    if (linear.solve(Mx, 1e-4, y) != LinearStatus::done) return 0;
    // With x^T M x = 1 the Rayleigh quotient of y = K^-1 M x is (y^T M x) / (y^T M y).
    Vector My;
    multiply(M, y, My);
    const double before = square;
    square = dot(y, Mx) / dot(y, My);
    x = y;
    if (std::abs(square - before) < 1e-3 * square) break;
  }
  return square > 0 && std::isfinite(square) ? 2 * std::numbers::pi / std::sqrt(square) : 0;
}

}  // namespace

long count_unknowns(const Model& model, const Numbering& numbering, int step) {
  const Supports supports =
      make_supports(model.steps[static_cast<std::size_t>(step)], numbering, Vector::Zero(3 * numbering.nodes()));
  long held = 0;
  for (const Mat3& P : supports.slides.projection) held += std::lround(3 - P.trace());
  return std::count(supports.fixed.begin(), supports.fixed.end(), 0) - held;
}

long unknowns(const Model& model, int step) { return count_unknowns(model, make_elements(model)->numbering(), step); }

double euler_loss_per_cycle(double period, double dt) {
  const double w = 2 * std::numbers::pi * dt / period;
  const double steps = 2 * std::numbers::pi / std::atan(w);
  return 1 - std::pow(1 + w * w, -0.5 * steps);
}

Check check_answer(Run& run) {
  const Step& step = run.model.steps[static_cast<std::size_t>(run.now.step)];
  const Supports supports = make_supports(step, run.equations.numbering(), run.now.u);
  Check check;
  const bool good = run.outcome.stop == Stop::converged || run.outcome.stop == Stop::interrupted;
  if (good) check_balance(run, supports, check);
  check_deformation(run, check);
  const Integrator integrator = run.model.settings.integrator;
  if (is_dynamic(integrator) && !is_explicit(integrator) && good) {
    check.lowest_period = lowest_period(run, supports);
    // What adaptive steps lose is that of their mean, which is what matters as long as they are short.
    const double dt = run.model.settings.adaptive_step && run.pieces > 0 ? run.now.time / run.pieces : step.dt;
    if (run.model.settings.integrator == Integrator::implicit_euler && check.lowest_period > 0)
      check.damped_per_cycle = euler_loss_per_cycle(check.lowest_period, dt);
  }
  return check;
}

}  // namespace msml::fe
