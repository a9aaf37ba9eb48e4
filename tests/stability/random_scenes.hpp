// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes drawn at random: law, element, mesh quality, load, integration and linear solver, from a seed.
#pragma once
#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "solver/registry.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  /// From low to high, every power of ten as likely.
  double power(double low, double high) { return std::exp(number(std::log(low), std::log(high))); }
  int index(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  bool chance(double p) { return number(0, 1) < p; }

 private:
  std::mt19937 engine_;
};

struct Drawn {
  std::string words;  ///< what was drawn, for messages
  Model model;
};

constexpr double drawn_length = 2, drawn_young = 1000;

/// A law with E = 1000 and a ratio of 0 to .4999.
inline std::shared_ptr<const Law> draw_law(Draw& draw, int law, std::string& words) {
  const double nu = draw.chance(0.2) ? draw.number(0.45, 0.4999) : draw.number(0, 0.45);
  const char* const forms[] = {"log", "cubic", "stable"};
  words += fmt::format("nu {:.3f}, ", nu);
  if (law < 2)
    return make_linear_elastic(
        {.youngs_modulus = drawn_young, .poisson_ratio = nu, .strain = law == 0 ? Strain::small : Strain::corotated});
  if (law == 2) return law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", drawn_young}, {"poissonRatio", nu}});
  return neo_hookean(forms[law - 3], drawn_young, nu);
}

/// The same tetrahedra with a node amid each edge.
inline Mesh with_mid_nodes(const Mesh& linear) {
  std::map<std::array<int, 2>, int> known;
  std::vector<Vec3> points;
  for (int k = 0; k < linear.point_count(); ++k) points.push_back(linear.points.row(k).transpose());
  Mesh mesh;
  for (int e = 0; e < linear.cell_count(); ++e) {
    std::array<int, 10> nodes;
    for (int a = 0; a < 4; ++a) nodes[static_cast<std::size_t>(a)] = linear.cell(e)[a];
    for (int k = 0; k < 6; ++k) {
      const auto [a, b] = edge_of(k);
      const int i = linear.cell(e)[a], j = linear.cell(e)[b];
      const auto [it, fresh] = known.emplace(std::array<int, 2>{std::min(i, j), std::max(i, j)}, points.size());
      if (fresh) points.push_back((linear.points.row(i) + linear.points.row(j)).transpose() / 2);
      nodes[static_cast<std::size_t>(4 + k)] = it->second;
    }
    mesh.add_cell(CellKind::tet10, nodes.data());
  }
  mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) mesh.points.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  return mesh;
}

/// A bar of 2 x 1 x 1 whose inner nodes are moved by up to `rough` of the mesh size.
inline Mesh draw_mesh(Draw& draw, CellKind kind, std::string& words) {
  const int n = 1 + draw.index(2);
  const double rough = draw.chance(0.5) ? 0 : draw.number(0.05, 0.3);
  words += fmt::format("{} n = {} rough {:.2f}, ", name(kind), n, rough);
  Mesh mesh = box_mesh(2 * n, n, n, {drawn_length, 1, 1}, CellKind::tet4);
  for (int k = 0; k < mesh.point_count(); ++k) {
    const Vec3 x = mesh.points.row(k).transpose();
    for (int i = 0; i < 3; ++i)
      if (x[i] > 1e-9 && x[i] < (i == 0 ? drawn_length : 1) - 1e-9) mesh.points(k, i) += draw.number(-1, 1) * rough / n;
  }
  return kind == CellKind::tet4 ? mesh : with_mid_nodes(mesh);
}

/// A pull, a moved, a turned end or gravity, from harmless to absurd.
inline void draw_load(Draw& draw, Model& model, std::string& words) {
  Step& step = model.steps[0];
  const auto end = [](const Vec3& x) { return x[0] > drawn_length - 1e-9; };
  const Vec3 direction = Vec3(draw.number(-1, 1), draw.number(-1, 1), draw.number(-1, 1)).normalized();
  Prescribed moved{.name = "end", .nodes = points_where(*model.mesh, end)};
  switch (draw.index(4)) {
    case 0: {
      const double size = drawn_young * draw.power(1e-3, 10);
      words += fmt::format("traction {:.3g} ({:.2f} {:.2f} {:.2f}), ", size, direction[0], direction[1], direction[2]);
      step.face_loads = {{.name = "pull", .faces = faces_where(*model.mesh, end), .tractions = {size * direction}}};
      return;
    }
    case 1: {
      const double size = drawn_length * draw.power(1e-2, 2.5);
      words += fmt::format("end moved {:.3g} ({:.2f} {:.2f} {:.2f}), ", size, direction[0], direction[1], direction[2]);
      moved.values = {size * direction};
      break;
    }
    case 2: {
      const double angle = draw.power(0.05, 4 * M_PI), whole = step.dt * step.count;
      words += fmt::format("end turned {:.3g}, ", angle);
      moved.function = [=](const Vec3& X, double t) {
        const double a = angle * t / whole, y = X[1] - 0.5, z = X[2] - 0.5;
        return Vec3(0, std::cos(a) * y - std::sin(a) * z - y, std::sin(a) * y + std::cos(a) * z - z);
      };
      break;
    }
    default:
      step.gravity = drawn_young * draw.power(1e-3, 10) * direction;
      words += fmt::format("gravity {:.3g}, ", step.gravity.norm());
      return;
  }
  step.prescribed.push_back(moved);
}

inline void draw_settings(Draw& draw, Model& model, std::string& words) {
  constexpr Integrator methods[] = {
      Integrator::static_, Integrator::static_,           Integrator::quasi_static,     Integrator::implicit_euler,
      Integrator::newmark, Integrator::generalized_alpha, Integrator::symplectic_euler, Integrator::central_difference};
  Settings& settings = model.settings;
  settings.integrator = methods[draw.index(8)];
  model.steps[0].dt = is_explicit(settings.integrator) ? draw.power(1e-4, 3e-2) : draw.power(1e-3, 1);
  model.steps[0].count = is_dynamic(settings.integrator) ? 10 : 4;
  settings.load_steps = 1 + draw.index(5);
  if (is_dynamic(settings.integrator) && draw.chance(0.3)) settings.damping_mass = draw.power(1e-2, 10);
  if (!is_explicit(settings.integrator) && is_dynamic(settings.integrator) && draw.chance(0.2))
    settings.newton_iterations = 1;
  settings.linear_solver = draw.chance(0.7) ? LinearSolver::direct : LinearSolver::cg;
  constexpr Preconditioner preconditioners[] = {Preconditioner::jacobi, Preconditioner::incomplete_cholesky,
                                                Preconditioner::multigrid, Preconditioner::automatic};
  settings.preconditioner = preconditioners[draw.index(4)];
  words += fmt::format("{} dt {:.3g} {} iterations {} ", name(settings.integrator), model.steps[0].dt,
                       settings.newton_iterations, settings.linear_solver == LinearSolver::cg ? "CG" : "direct");
}

inline Drawn draw_scene(unsigned seed) {
  Draw draw(seed);
  Drawn drawn{fmt::format("seed {}: ", seed), {}};
  const int law = draw.index(6);
  constexpr const char* laws[] = {"small", "corotated", "St. Venant-Kirchhoff", "log", "cubic", "stable"};
  drawn.words += fmt::format("{} ", laws[law]);
  const auto material = draw_law(draw, law, drawn.words);
  const CellKind kind = draw.chance(0.5) ? CellKind::tet4 : CellKind::tet10;
  drawn.model = make_model(draw_mesh(draw, kind, drawn.words), {});
  drawn.model.regions[0].law = material;
  if (kind == CellKind::tet10 && law == 1 && draw.chance(0.4)) drawn.model.formulation = Formulation::single_rotation;
  draw_settings(draw, drawn.model, drawn.words);
  const auto wall = points_where(*drawn.model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  drawn.model.steps[0].prescribed = {fix(wall)};
  draw_load(draw, drawn.model, drawn.words);
  return drawn;
}

}  // namespace msml::fe::testing
