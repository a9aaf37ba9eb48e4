// SPDX-License-Identifier: GPL-3.0-or-later
// Bars whose states are known: bent by a moment, twisted by an end.
#pragma once
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {

constexpr double bar_length = 5;

/// A bar [0,5] x [0,1] x [0,1] of 5n x n x n cubes, small strain, E = 1000, bent to the curvature kappa by tractions
/// -E kappa (z - 1/2) on its end: u = kappa (-x z', (nu y' z'), (x^2 + nu (z'^2 - y'^2))/2) for every Poisson's ratio,
/// with y', z' from the axis (de Saint-Venant, 1855). The first face slides in its plane; two nodes of it are held.
inline Model bent_bar(CellKind kind, int n, double poisson_ratio, double kappa) {
  const double E = 1000;
  Model model = make_model(box_mesh(5 * n, 2 * n, 2 * n, {bar_length, 1, 1}, kind),
                           {.youngs_modulus = E, .poisson_ratio = poisson_ratio, .strain = Strain::small});
  const auto face = points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  Step& step = model.steps[0];
  step.prescribed = {fix(face, true, false, false), fix({nearest_point(*model.mesh, {0, 0.5, 0.5})}, false, true, true),
                     fix({nearest_point(*model.mesh, {0, 0.5, 1})}, false, true, false)};
  FaceLoad moment{.name = "moment"};
  moment.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > bar_length - 1e-9; });
  moment.traction_function = [=](const Vec3& X, double) { return Vec3(-E * kappa * (X[2] - 0.5), 0, 0); };
  moment.steady = true;
  step.face_loads = {moment};
  return model;
}

/// A bar [0,1] x [0,1] x [0,4] of n x n x 4n cubes, corotated, held at z = 0 and turned at z = 4 by an angle.
inline Model twisted_bar(CellKind kind, int n, double angle) {
  Model model = make_model(box_mesh(n, n, 4 * n, {1, 1, 4}, kind),
                           {.youngs_modulus = 1000, .poisson_ratio = 0.3, .strain = Strain::corotated});
  Prescribed end{.name = "end", .nodes = points_where(*model.mesh, [](const Vec3& x) { return x[2] > 4 - 1e-9; })};
  end.function = [=](const Vec3& X, double t) {
    const double a = angle * t, x = X[0] - 0.5, y = X[1] - 0.5;
    return Vec3(std::cos(a) * x - std::sin(a) * y - x, std::sin(a) * x + std::cos(a) * y - y, 0);
  };
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; })), end};
  model.settings.load_steps = 4;
  return model;
}

}  // namespace msml::fe::testing
