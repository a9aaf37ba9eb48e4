// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes drawn at random: law, element, mesh quality, support, load, integration and linear solver, from a seed.
#pragma once
#include "tests/stability/random_laws.hpp"
#include "tests/stability/random_meshes.hpp"

namespace msml::fe::testing {

/// The end turned by an angle in the course of the step.
inline VectorFunction turning(double angle, double whole) {
  return [=](const Vec3& X, double t) {
    const double a = angle * t / whole, y = X[1] - 0.5, z = X[2] - 0.5;
    return Vec3(0, std::cos(a) * y - std::sin(a) * z - y, std::sin(a) * y + std::cos(a) * z - z);
  };
}

/// Springs from nodes to where they are, or to a point off them.
inline void add_springs(Draw& draw, Step& step, const Mesh& mesh, const std::vector<int>& nodes, const Vec3& off) {
  const double stiffness = drawn_young * draw.power(1e-2, 10);
  for (const int n : nodes)
    step.springs.push_back({.name = "spring",
                            .first = n,
                            .point = mesh.points.row(n).transpose() + off,
                            .stiffness = stiffness,
                            .damping = draw.chance(0.5) ? 0 : 0.01 * stiffness,
                            .rest = off.norm() > 0 && draw.chance(0.5) ? 0.5 * off.norm() : 0});
}

/// Held at a wall, by springs, or not at all; a free static body is pulled at both ends alike.
inline void draw_support(Draw& draw, Model& model, std::string& words) {
  Step& step = model.steps[0];
  const auto wall = points_where(*model.mesh, at_wall);
  const double kind = draw.number(0, 1);
  if (kind < 0.8) {
    step.prescribed = {fix(wall)};
  } else if (kind < 0.9) {
    words += "on springs, ";
    add_springs(draw, step, *model.mesh, wall, Vec3::Zero());
  } else {
    words += "free, ";
  }
}

/// A pull, a pressure, springs, a moved, a turned end or gravity, from harmless to absurd.
inline void draw_load(Draw& draw, Model& model, std::string& words) {
  Step& step = model.steps[0];
  const Vec3 direction = draw.direction();
  const auto end = points_where(*model.mesh, at_end);
  switch (draw.index(6)) {
    case 0: {
      const double size = drawn_young * draw.power(1e-3, 10);
      words += fmt::format("traction {:.3g} ({:.2f} {:.2f} {:.2f}), ", size, direction[0], direction[1], direction[2]);
      step.face_loads = {{.name = "pull", .faces = faces_where(*model.mesh, at_end), .tractions = {size * direction}}};
      return;
    }
    case 1: {
      const double size = drawn_length * draw.power(1e-2, 2.5);
      words += fmt::format("end moved {:.3g} ({:.2f} {:.2f} {:.2f}), ", size, direction[0], direction[1], direction[2]);
      step.prescribed.push_back({.name = "end", .nodes = end, .values = {size * direction}});
      return;
    }
    case 2: {
      const double angle = draw.power(0.05, 4 * M_PI);
      words += fmt::format("end turned {:.3g}, ", angle);
      step.prescribed.push_back({.name = "end", .nodes = end, .function = turning(angle, step.dt * step.count)});
      return;
    }
    case 3: {
      const double size = drawn_young * draw.power(1e-3, 1) * (draw.chance(0.5) ? 1 : -1);
      const bool side = draw.chance(0.5);
      words += fmt::format("follower pressure {:.3g} on {}, ", size, side ? "a side" : "the end");
      const auto at_side = [](const Vec3& x) { return x[2] > 1 - 1e-9; };
      step.face_loads = {{.name = "pressure",
                          .faces = side ? faces_where(*model.mesh, at_side) : faces_where(*model.mesh, at_end),
                          .pressures = {size},
                          .follower = true}};
      return;
    }
    case 4:
      words += fmt::format("springs to ({:.2f} {:.2f} {:.2f}), ", direction[0], direction[1], direction[2]);
      add_springs(draw, step, *model.mesh, end, drawn_length * draw.power(1e-2, 2) * direction);
      return;
    default:
      step.gravity = drawn_young * draw.power(1e-3, 10) * direction;
      words += fmt::format("gravity {:.3g}, ", step.gravity.norm());
      return;
  }
}

/// A dead pull on both ends, which nothing needs to hold, along the bar: loads a static body without supports bears.
inline void draw_balanced_load(Draw& draw, Model& model, std::string& words) {
  const double size = drawn_young * draw.power(1e-3, 1);
  words += fmt::format("pulled at both ends {:.3g}, ", size);
  const Vec3 x = Vec3::UnitX();
  model.steps[0].face_loads = {
      {.name = "end", .faces = faces_where(*model.mesh, at_end), .tractions = {size * x}},
      {.name = "other end", .faces = faces_where(*model.mesh, at_wall), .tractions = {-size * x}}};
}

inline void draw_integration(Draw& draw, Model& model, bool explicit_too) {
  constexpr Integrator methods[] = {
      Integrator::static_, Integrator::static_,           Integrator::quasi_static,     Integrator::implicit_euler,
      Integrator::newmark, Integrator::generalized_alpha, Integrator::symplectic_euler, Integrator::central_difference};
  Settings& settings = model.settings;
  settings.integrator = methods[draw.index(explicit_too ? 8 : 6)];
  model.steps[0].dt = is_explicit(settings.integrator) ? draw.power(1e-4, 3e-2) : draw.power(1e-3, 1);
  model.steps[0].count = is_dynamic(settings.integrator) ? 10 : 4;
  settings.load_steps = 1 + draw.index(5);
  if (is_dynamic(settings.integrator) && draw.chance(0.3)) settings.damping_mass = draw.power(1e-2, 10);
  if (!is_explicit(settings.integrator) && is_dynamic(settings.integrator) && draw.chance(0.2))
    settings.newton_iterations = 1;
  // Absurd loads in adaptive steps take thousands of them.
  settings.adaptive_step = !is_explicit(settings.integrator) && draw.chance(0.2) && model.mesh->point_count() < 100;
}

inline void draw_solver(Draw& draw, Model& model, bool gradients_too, std::string& words) {
  Settings& settings = model.settings;
  settings.linear_solver = draw.chance(0.7) || !gradients_too ? LinearSolver::direct : LinearSolver::cg;
  constexpr Preconditioner preconditioners[] = {Preconditioner::jacobi, Preconditioner::incomplete_cholesky,
                                                Preconditioner::multigrid, Preconditioner::automatic};
  settings.preconditioner = preconditioners[draw.index(4)];
  words += fmt::format("{} dt {:.3g} {} iterations{} {} ", name(settings.integrator), model.steps[0].dt,
                       settings.newton_iterations, settings.adaptive_step ? " adaptive" : "",
                       settings.linear_solver == LinearSolver::cg ? "CG" : "direct");
}

/// An element that goes with the law, and the law.
inline void draw_body(Draw& draw, Drawn& drawn) {
  const auto family = static_cast<Family>(draw.index(families));
  drawn.words += fmt::format("{} ", name(family));
  const CellKind kind = draw.chance(0.5) ? CellKind::tet4 : CellKind::tet10;
  const bool other = draw.chance(0.4), quadratic = kind == CellKind::tet10;
  const auto material = draw_law(draw, family, other && quadratic, drawn.words);
  drawn.model = make_model(draw_mesh(draw, kind, drawn.words), {});
  drawn.model.regions[0].law = material;
  if (!other) return;
  const auto split = material->split();
  if (quadratic && family == Family::corotated && draw.chance(0.5)) {
    drawn.model.formulation = Formulation::single_rotation;
    drawn.words += "single rotation, ";
  } else if (split && split->modulus[0] > 0) {
    drawn.model.formulation = quadratic ? Formulation::mixed : Formulation::fbar;
    drawn.words += quadratic ? "mixed, " : "fbar, ";
  }
}

inline Drawn draw_scene(unsigned seed) {
  Draw draw(seed);
  Drawn drawn{fmt::format("seed {}: ", seed), {}};
  draw_body(draw, drawn);
  Model& model = drawn.model;
  const bool mixed = model.formulation == Formulation::mixed;
  draw_integration(draw, model, !mixed);
  if (model.formulation == Formulation::standard && draw.chance(0.15)) {
    model.regions[0].prony = {.g = {draw.number(0.1, 0.5), draw.number(0.1, 0.4)}, .tau = {draw.power(1e-2, 1), 1}};
    drawn.words += "viscoelastic, ";
  }
  draw_support(draw, model, drawn.words);
  const bool held = !model.steps[0].prescribed.empty() || !model.steps[0].springs.empty();
  if (held || is_dynamic(model.settings.integrator))
    draw_load(draw, model, drawn.words);
  else
    draw_balanced_load(draw, model, drawn.words);
  draw_solver(draw, model, !mixed, drawn.words);
  return drawn;
}

}  // namespace msml::fe::testing
