// SPDX-License-Identifier: GPL-3.0-or-later
// One vibrating unknown whose motion is known exactly.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {

/// One tetrahedron with unit edges along the axes and three nodes held; node 3 moves along z only. By hand:
/// k = V (lambda + 2 mu) with V = 1/6; m = rho V / 10 consistent (2 rho V / 20), rho V / 4 lumped.
struct Oscillator {
  double k, m;
  double omega() const { return std::sqrt(k / m); }
  double period() const { return 2 * M_PI / omega(); }
};

constexpr double young = 100, poisson = 0.25, density = 3;

inline Oscillator oscillator(bool lumped) {
  const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  return {(lambda + 2 * mu) / 6, density / 6 / (lumped ? 4 : 10)};
}

/// The oscillator, pulled by a force f from t = 0 on.
inline Model oscillator_model(Integrator integrator, bool lumped, double dt, int count, double f = 0.1) {
  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const int nodes[4] = {0, 1, 2, 3};
  mesh.add_cell(CellKind::tet4, nodes);
  Model model = make_model(std::move(mesh),
                           {.youngs_modulus = young, .poisson_ratio = poisson, .strain = Strain::small}, density);
  model.settings.integrator = integrator;
  model.settings.lumped_mass = lumped;
  model.settings.tolerance = 1e-12;
  Step& step = model.steps[0];
  step.dt = dt;
  step.count = count;
  step.prescribed = {fix({0, 1, 2}), fix({3}, true, true, false)};
  step.forces = {{.name = "pull", .nodes = {3}, .values = {Vec3(0, 0, f)}}};
  return model;
}

/// Error at t = 0.6 periods against u = f/k (1 - exp(-z w t) (cos wd t + z w / wd sin wd t)), relative to f/k.
inline double error_at_end(Integrator integrator, bool lumped, int count, double alpha = 0, double beta = 0) {
  const Oscillator o = oscillator(lumped);
  const double end = 0.6 * o.period(), f = 0.1;
  Model model = oscillator_model(integrator, lumped, end / count, count, f);
  model.settings.damping_mass = alpha;
  model.settings.damping_stiffness = beta;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double w = o.omega(), z = (alpha / w + beta * w) / 2, wd = w * std::sqrt(1 - z * z);
  const double exact = f / o.k * (1 - std::exp(-z * w * end) * (std::cos(wd * end) + z * w / wd * std::sin(wd * end)));
  return std::abs(outcome.state.displacement(3, 2) - exact) / (f / o.k);
}

/// Observed order in time between `count` steps and twice as many.
inline double order_in_time(Integrator integrator, bool lumped, int count, double alpha = 0, double beta = 0) {
  return std::log2(error_at_end(integrator, lumped, count, alpha, beta) /
                   error_at_end(integrator, lumped, 2 * count, alpha, beta));
}

}  // namespace msml::fe::testing
