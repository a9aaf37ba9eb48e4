// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes in which one thing is wrong on purpose, each with a twin in which it is not.
#pragma once
#include "tests/stability/random_laws.hpp"
#include "tests/stability/random_meshes.hpp"

namespace msml::fe::testing {

constexpr int causes = 10;

struct Planted {
  std::string cause;
  std::string word;         ///< must be in what is said
  std::vector<Stop> stops;  ///< one of them is how it ends; empty: it is refused
  Model model;
};

inline Model plain_bar(Draw& draw) {
  const int n = 1 + draw.index(2);
  Model model = make_model(box_mesh(2 * n, n, n, {drawn_length, 1, 1}, CellKind::tet4),
                           {.youngs_modulus = drawn_young, .poisson_ratio = draw.number(0, 0.45)}, 1);
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_wall))};
  model.settings.load_steps = 2 + draw.index(8);
  return model;
}

inline FaceLoad pull_on(const Model& model, const Vec3& traction) {
  return {.name = "pull", .faces = faces_where(*model.mesh, at_end), .tractions = {traction}};
}

/// All nodes move along x alone: one stretch is all there is.
inline void hold_sideways(Model& model) {
  const auto all = points_where(*model.mesh, [](const Vec3&) { return true; });
  model.steps[0].prescribed.push_back(fix(all, false, true, true));
}

inline void move_end(Model& model, double x) {
  model.steps[0].prescribed.push_back(
      {.name = "end", .nodes = points_where(*model.mesh, at_end), .values = {Vec3(x, 0, 0)}});
}

/// The stable step is found, and exceeded by 5 % to a thousandfold.
inline Planted plant_unstable_step(Draw& draw, Model model, bool wrong) {
  model.settings.integrator = draw.chance(0.5) ? Integrator::symplectic_euler : Integrator::central_difference;
  model.settings.lumped_mass = true;
  model.steps[0].face_loads = {pull_on(model, Vec3(1, 0.5, 0.2))};
  model.steps[0].dt = 1;
  model.steps[0].dt = solve(model, {}).stable_step * (wrong ? draw.power(1.05, 1000) : 0.95);
  return {"time step over the limit", "is unstable above", {Stop::unstable_step}, model};
}

/// The end is pushed beyond the wall.
inline Planted plant_inversion(Draw& draw, Model model, bool wrong) {
  model.regions[0].law = neo_hookean("log", drawn_young, draw.number(0, 0.45));
  hold_sideways(model);
  move_end(model, -drawn_length * (wrong ? draw.number(1.1, 3) : 0.3));
  return {"inverted element", "inverted element", {Stop::inverted_element}, model};
}

inline Planted plant_free_motion(Draw& draw, Model model, bool wrong) {
  if (wrong) model.steps[0].prescribed.clear();
  model.steps[0].face_loads = {pull_on(model, draw.direction())};
  return {"unconstrained motion", "rigid motions", {}, model};
}

/// P = E/2 l (l^2 - 1) turns at -E/(3 sqrt(3)).
inline Planted plant_limit_point(Draw& draw, Model model, bool wrong) {
  model.regions[0].law =
      law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", drawn_young}, {"poissonRatio", 0.0}});
  hold_sideways(model);
  const double turn = drawn_young / (3 * std::sqrt(3.0));
  model.steps[0].face_loads = {pull_on(model, Vec3(-turn * (wrong ? draw.power(1.02, 10) : 0.97), 0, 0))};
  return {"load past a limit point", "pass a limit point", {Stop::singular, Stop::indefinite_tangent}, model};
}

/// The same rod between two walls, shortened below 1/sqrt(3) of its length.
inline Planted plant_indefinite(Draw& draw, Model model, bool wrong) {
  model.regions[0].law =
      law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", drawn_young}, {"poissonRatio", 0.0}});
  hold_sideways(model);
  model.settings.load_steps = 20;
  move_end(model, -drawn_length * (wrong ? draw.number(0.45, 0.6) : 0.4));
  return {"loss of definiteness", "the equilibrium is unstable", {Stop::indefinite_tangent}, model};
}

/// A corner of an element is pushed through the face opposite.
inline Planted plant_bad_element(Draw& draw, Model model, bool wrong) {
  model.steps[0].face_loads = {pull_on(model, draw.direction())};
  Mesh mesh = *model.mesh;
  const int element = draw.index(mesh.cell_count()), corner = draw.index(4);
  const int* nodes = mesh.cell(element);
  Vec3 foot = Vec3::Zero();
  for (int a = 0; a < 4; ++a)
    if (a != corner) foot += mesh.points.row(nodes[a]).transpose() / 3;
  const Vec3 way = foot - mesh.points.row(nodes[corner]).transpose();
  if (wrong) mesh.points.row(nodes[corner]) += draw.number(1.1, 3) * way.transpose();
  model.mesh = std::make_shared<const Mesh>(mesh);
  return {"bad element", "inverted or flat in the reference mesh", {}, model};
}

/// A ratio so near one half that conjugate gradients run into their limit.
inline Planted plant_gradients(Draw& draw, Model model, bool wrong) {
  const double nu = wrong ? 0.5 - draw.power(1e-7, 3e-6) : 0.3;
  model = make_model(box_mesh(8, 4, 4, {drawn_length, 1, 1}, CellKind::tet4),
                     {.youngs_modulus = drawn_young, .poisson_ratio = nu, .strain = Strain::small});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_wall))};
  model.steps[0].face_loads = {pull_on(model, draw.direction())};
  model.settings.linear_solver = LinearSolver::cg;
  model.settings.preconditioner = draw.chance(0.5) ? Preconditioner::none : Preconditioner::jacobi;
  return {"linear solver", "a factorisation took over", {Stop::converged}, model};
}

/// One linear solve for a pull that acts at once, in a law that stiffens with the fifth power of the stretch.
inline Planted plant_long_step(Draw& draw, Model model, bool wrong) {
  model.regions[0].law = neo_hookean("stable", drawn_young, draw.number(0.1, 0.45));
  model.steps[0].face_loads = {pull_on(model, Vec3(draw.power(1e6, 1e7), 0, 0))};
  model.settings.integrator = Integrator::newmark;
  model.settings.newton_iterations = 1;
  model.steps[0].dt = wrong ? draw.number(0.5, 1) : 1e-5;
  return {"step too large", "step too large", {Stop::step_too_large}, model};
}

/// Nearly all of the body is in one point at the start: a local minimum of the cubic law, but not of the stable one.
inline Planted plant_collapse(Draw& draw, Model model, bool wrong) {
  model.regions[0].law = neo_hookean(wrong ? "cubic" : "stable", drawn_young, draw.number(0.1, 0.45));
  model.steps[0].prescribed.clear();
  model.settings.untangle = false;
  model.initial_displacement = -draw.number(0.985, 0.995) * model.mesh->points;
  return {"collapsed equilibrium", "collapsed equilibrium", {Stop::collapsed}, model};
}

inline Planted plant_combination(Draw& draw, Model model, bool wrong) {
  const double mu = draw.power(1, 1000);
  Attributes attributes{{"c1", mu / 2}, {"incompressible", wrong}};
  if (!wrong) attributes.emplace_back("bulkModulus", 10 * mu);
  model.regions[0].law = law_by_name("mooneyRivlinMaterial", attributes);
  model.steps[0].face_loads = {pull_on(model, 0.01 * mu * draw.direction())};
  return {"law and element that exclude each other", "is incompressible, which needs", {}, model};
}

/// Each cause in turn; without `wrong` the twin.
inline Planted plant(unsigned seed, bool wrong) {
  Draw draw(1000 + seed);
  constexpr std::array<Planted (*)(Draw&, Model, bool), causes> plants{
      plant_unstable_step, plant_inversion, plant_free_motion, plant_limit_point, plant_indefinite,
      plant_bad_element,   plant_gradients, plant_long_step,   plant_collapse,    plant_combination};
  const Model bar = plain_bar(draw);
  return plants[seed % causes](draw, bar, wrong);
}

}  // namespace msml::fe::testing
