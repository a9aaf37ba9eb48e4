// SPDX-License-Identifier: GPL-3.0-or-later
// Mixed and patch elements: derivatives, and closed forms near and at incompressibility.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "msml/core/error.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/elements/patches.hpp"
#include "solver/materials/linear_elastic.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

const char* spelled(Formulation formulation) {
  return formulation == Formulation::mixed ? "mixed" : formulation == Formulation::fbar ? "fbar" : "standard";
}

/// neoHookeanMaterial with a shear modulus of 1.
std::shared_ptr<const Law> incompressible_rubber() {
  for (const MaterialFactory& material : materials()) {
    if (material.tag() != "neoHookeanMaterial") continue;
    Record record = sample_record(material);
    for (std::size_t s = 0; s < material.slots().size(); ++s) {
      const std::string& slot = material.slots()[s].name;
      if (slot == "youngModulus") record.values[s] = 3.0;
      if (slot == "incompressible") record.values[s] = true;
      if (slot == "poissonRatio") record.values[s] = Value{};
      record.given[s] = slot == "youngModulus" || slot == "incompressible";
    }
    return material.make(record);
  }
  return nullptr;
}

void expect_exact_tangent(const Model& model) {
  const auto elements = make_elements(model);
  const int size = 3 * elements->numbering().nodes();
  Random random;
  Vector u(size);
  for (Eigen::Index k = 0; k < size; ++k) u[k] = 0.05 * random.number();
  BlockMatrix K(elements->pattern());
  Vector force = Vector::Zero(size);
  elements->add_internal(u, Want::tangent, force, &K);
  Eigen::MatrixXd dense(size, size);
  for (int k = 0; k < size; ++k) {
    Vector column;
    multiply(K, Vector::Unit(size, k), column);
    dense.col(k) = column;
  }
  EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
  for (int k = 0; k < size; ++k) {
    Vector up = Vector::Zero(size), down = up;
    const double h = 1e-5;  // central differences: round-off 1e-16 / h, truncation h^2
    elements->add_internal(u + h * Vector::Unit(size, k), Want::stress, up, nullptr);
    elements->add_internal(u - h * Vector::Unit(size, k), Want::stress, down, nullptr);
    EXPECT_LT(((up - down) / (2 * h) - dense.col(k)).norm(), 1e-8 * dense.norm()) << k;
  }
}

TEST(EveryFormulation, HasTheTangentOfItsForces) {
  for (const Formulation formulation : {Formulation::mixed, Formulation::fbar}) {
    const CellKind kind = formulation == Formulation::mixed ? CellKind::tet10 : CellKind::tet4;
    for (const Strain strain : {Strain::small, Strain::corotated}) {
      Model model = make_model(box_mesh(2, 1, 1, {2, 1, 1}, kind),
                               {.youngs_modulus = 10, .poisson_ratio = 0.45, .strain = strain});
      model.formulation = formulation;
      expect_exact_tangent(model);
    }
  }
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet10), {});
  model.formulation = Formulation::mixed;
  model.regions[0].law = incompressible_rubber();
  expect_exact_tangent(model);
}

TEST(Patches, HoldEveryElementOnceAndStaySmall) {
  const Model model = make_model(sphere_octant(4, 1, 2, CellKind::tet4), {});
  const Numbering numbering = number(model);
  std::vector<int> seen(numbering.elements.size(), 0);
  const auto patches = make_patches(numbering, 8);
  for (const std::vector<int>& patch : patches) {
    EXPECT_LE(patch.size(), static_cast<std::size_t>(patch_limit));
    for (const int e : patch) ++seen[static_cast<std::size_t>(e)];
  }
  for (const int count : seen) EXPECT_EQ(count, 1);
  EXPECT_GT(static_cast<double>(seen.size()) / static_cast<double>(patches.size()), 7);
}

/// The hollow sphere of reference-free Lame: a = 1, b = 2, E = 1000, p = 1 inside,
/// u(a) = p a^3 / (E (b^3 - a^3)) ((1 - 2 nu) a + (1 + nu) b^3 / (2 a^2)).
constexpr double sphere_poisson = 0.4999;
constexpr double sphere_u = (1 - 2 * sphere_poisson + (1 + sphere_poisson) * 4) / 7000;

void hold_octant(Model& model) {
  for (int d = 0; d < 3; ++d)
    model.steps[0].prescribed.push_back(
        fix(points_where(*model.mesh, [&](const Vec3& x) { return std::abs(x[d]) < 1e-9; }), d == 0, d == 1, d == 2));
}

bool is_inside(const Vec3& x) { return std::abs(x.norm() - 1) < 1e-9; }

/// Mean of the radial displacement of the inner nodes.
double inner_displacement(const Model& model, const State& state) {
  double sum = 0;
  const std::vector<int> nodes = points_where(*model.mesh, is_inside);
  for (const int n : nodes) sum += state.displacement.row(n).dot(model.mesh->points.row(n));
  return sum / static_cast<double>(nodes.size());
}

Outcome solve_sphere(Model& model, int n, Formulation formulation) {
  const CellKind kind = formulation == Formulation::mixed ? CellKind::tet10 : CellKind::tet4;
  model = make_model(sphere_octant(n, 1, 2, kind),
                     {.youngs_modulus = 1000, .poisson_ratio = sphere_poisson, .strain = Strain::small});
  model.formulation = formulation;
  hold_octant(model);
  model.steps[0].face_loads = {{.name = "inside", .faces = faces_where(*model.mesh, is_inside), .pressures = {1}}};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double x = outcome.state.displacement(nearest_point(*model.mesh, {1, 0, 0}), 0);
  std::cout << fmt::format(
      "hollow sphere nu = {} {:8} n = {:2} ({} unknowns): u(a) {:.4f} of the exact in the mean, "
      "{:.4f} at the worst node\n",
      sphere_poisson, spelled(formulation), n, outcome.unknowns, inner_displacement(model, outcome.state) / sphere_u,
      x / sphere_u);
  return outcome;
}

TEST(HollowSphere, IsWithinOnePercentAlmostIncompressible) {
  Model model;
  const Outcome mixed = solve_sphere(model, 3, Formulation::mixed);
  EXPECT_NEAR(inner_displacement(model, mixed.state), sphere_u, 0.01 * sphere_u);
  EXPECT_NEAR(mixed.state.displacement(nearest_point(*model.mesh, {1, 0, 0}), 0), sphere_u, 0.01 * sphere_u);
  // Mean stress p a^3 / (b^3 - a^3) = 1/7 everywhere: a pressure of -1/7.
  for (const int n : points_where(*model.mesh, [](const Vec3&) { return true; }))
    EXPECT_NEAR(mixed.state.pressure[static_cast<std::size_t>(n)], -1.0 / 7, 0.03);
  const Outcome fbar = solve_sphere(model, 12, Formulation::fbar);
  EXPECT_NEAR(inner_displacement(model, fbar.state), sphere_u, 0.01 * sphere_u);
  const Outcome plain = solve_sphere(model, 12, Formulation::standard);
  EXPECT_LT(plain.state.displacement(nearest_point(*model.mesh, {1, 0, 0}), 0), 0.5 * sphere_u);
}

/// Tip deflection of the small-strain cantilever under gravity, nu = 0.4999.
double beam_tip(int n, CellKind kind, Formulation formulation) {
  Model model = beam_model(n, kind, 0.4999, Strain::small);
  model.formulation = formulation;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double deflection = -tip(model, outcome.state)[2];
  std::cout << fmt::format("cantilever nu = 0.4999 {:5} {:8} n = {} ({} unknowns): {:.6f}\n", name(kind),
                           spelled(formulation), n, outcome.unknowns, deflection);
  return deflection;
}

TEST(Cantilever, BendsAlmostIncompressible) {
  const double coarse = beam_tip(2, CellKind::tet10, Formulation::mixed);
  const double fine = beam_tip(4, CellKind::tet10, Formulation::mixed);
  const double exact = fine + (fine - coarse) / 3;  // order 2 in the deflection: the clamped edges are singular
  EXPECT_NEAR(fine, exact, 0.01 * exact);
  EXPECT_NEAR(beam_tip(10, CellKind::tet4, Formulation::fbar), exact, 0.05 * exact);
  EXPECT_LT(beam_tip(10, CellKind::tet4, Formulation::standard), 0.5 * exact);
}

/// Sphere A = 1, B = 1.5 of incompressible neo-Hookean rubber with mu = 1; see inflation_pressure.
Model rubber_sphere(int n) {
  Model model = make_model(sphere_octant(n, 1, 1.5, CellKind::tet10), {});
  model.formulation = Formulation::mixed;
  model.regions[0].law = incompressible_rubber();
  hold_octant(model);
  return model;
}

/// p = f(lb) - f(la), f(l) = 2/l + 1/(2 l^4), lb^3 = 1 + (la^3 - 1) A^3/B^3.
double inflation_pressure(double la) {
  const auto f = [](double l) { return 2 / l + 0.5 / std::pow(l, 4); };
  return f(std::cbrt(1 + (la * la * la - 1) / 3.375)) - f(la);
}

TEST(RubberSphere, ClosedFormHasTheKnownNumbers) {
  EXPECT_NEAR(inflation_pressure(1.1), 0.2202637, 1e-7);
  EXPECT_NEAR(inflation_pressure(1.25), 0.3949309, 1e-7);
}

TEST(RubberSphere, SwellsUnderPressureAsTheClosedFormSays) {
  Model model = rubber_sphere(3);
  model.steps[0].face_loads = {{.name = "inside",
                                .faces = faces_where(*model.mesh, is_inside),
                                .pressures = {inflation_pressure(1.1)},
                                .follower = true}};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const double stretch = 1 + inner_displacement(model, outcome.state);
  std::cout << fmt::format("rubber sphere, p = {:.7f}: la = {:.5f} for 1.1; volume change {:.1e}; {} iterations\n",
                           inflation_pressure(1.1), stretch, outcome.check.volume_change, outcome.newton_iterations);
  EXPECT_NEAR(stretch, 1.1, 0.005 * 1.1);
  EXPECT_NEAR(outcome.check.volume_change, 0, 1e-3);
}

TEST(RubberSphere, NeedsThePressureOfTheClosedForm) {
  for (const double la : {1.1, 1.25}) {
    Model model = rubber_sphere(3);
    Prescribed inside{.name = "inside", .nodes = points_where(*model.mesh, is_inside)};
    for (const int n : inside.nodes) inside.values.push_back((la - 1) * model.mesh->points.row(n).transpose());
    model.steps[0].prescribed.insert(model.steps[0].prescribed.begin(), inside);
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    double work = 0;  // of the inner forces under a unit radial motion: pressure times an eighth of the sphere
    for (const int n : inside.nodes) work += outcome.state.reaction.row(n).dot(model.mesh->points.row(n));
    const double pressure = work / (0.5 * std::numbers::pi * la * la);
    std::cout << fmt::format("rubber sphere, la = {}: p = {:.6f} for {:.7f}\n", la, pressure, inflation_pressure(la));
    EXPECT_NEAR(pressure, inflation_pressure(la), 0.005 * inflation_pressure(la));
  }
}

// Both halves are strained alike, so that the pressures are -k e with k = E/(3 (1 - 2 nu)) of each, and the stresses
// along and across sigma = lambda e + 2 mu e and lambda e: closed forms of linear elasticity.
TEST(MixedElements, HaveAPressureOfTheirOwnInEachRegion) {
  Model model = make_model(box_mesh(4, 1, 1, {2, 0.5, 0.5}, CellKind::tet10), {});
  model.formulation = Formulation::mixed;
  model.settings.integrator = Integrator::static_;
  const double e = 0.01, nu = 0.49, young[2] = {1000, 500};
  Region whole = model.regions[0];
  model.regions.clear();
  for (int half = 0; half < 2; ++half) {
    Region region{.name = "half", .law = make_linear_elastic({young[half], nu, Strain::small}), .elements = {}};
    for (const int element : whole.elements) {
      double x = 0;
      for (int a = 0; a < 4; ++a) x += model.mesh->points(model.mesh->cell(element)[a], 0) / 4;
      if ((x > 1) == (half == 1)) region.elements.push_back(element);
    }
    model.regions.push_back(region);
  }
  Prescribed held{.name = "all", .nodes = points_where(*model.mesh, [](const Vec3&) { return true; })};
  for (const int n : held.nodes) held.values.push_back(Vec3(e * model.mesh->points(n, 0), 0, 0));
  model.steps[0].prescribed = {held};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  const ElementResults results = element_results(model, outcome.state);
  for (int half = 0; half < 2; ++half) {
    const double mu = young[half] / (2 * (1 + nu)), lambda = young[half] * nu / ((1 + nu) * (1 - 2 * nu));
    for (const int element : model.regions[static_cast<std::size_t>(half)].elements) {
      const double* stress = results.cauchy.data() + 6 * element;
      EXPECT_NEAR(stress[0], (lambda + 2 * mu) * e, 1e-9 * lambda * e);
      EXPECT_NEAR(stress[1], lambda * e, 1e-9 * lambda * e);
    }
  }
  const auto pressure = [&](double x) {
    return outcome.state.pressure[static_cast<std::size_t>(nearest_point(*model.mesh, {x, 0, 0}))];
  };
  const double k[2] = {young[0] / (3 * (1 - 2 * nu)), young[1] / (3 * (1 - 2 * nu))};
  EXPECT_NEAR(pressure(0.5), pressure(0), 1e-9 * k[0] * e);
  EXPECT_NEAR(pressure(0.5) / pressure(1.5), 2, 1e-9);
  EXPECT_NEAR(pressure(1), 0.5 * (pressure(0.5) + pressure(1.5)), 1e-9 * k[0] * e);
}

void expect_refused(const Model& model, const std::string& part) {
  try {
    model.check();
    FAIL() << "not refused: " << part;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
  }
}

TEST(EveryFormulation, IsRefusedWhereItMakesNoSense) {
  const auto model = [](CellKind kind, Formulation formulation, double nu) {
    Model made = make_model(box_mesh(1, 1, 1, {1, 1, 1}, kind), {.poisson_ratio = nu});
    made.steps[0].prescribed = {fix(points_where(*made.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    made.formulation = formulation;
    return made;
  };
  model(CellKind::tet10, Formulation::mixed, 0.3).check();
  model(CellKind::tet4, Formulation::fbar, 0.3).check();
  expect_refused(model(CellKind::tet4, Formulation::mixed, 0.3), "is for quadraticTet");
  expect_refused(model(CellKind::tet10, Formulation::fbar, 0.3), "is for linearTet");
  expect_refused(model(CellKind::tet10, Formulation::mixed, 0), "not > 0");
  Model cg = model(CellKind::tet10, Formulation::mixed, 0.3);
  cg.settings.linear_solver = LinearSolver::cg;
  expect_refused(cg, "linearSolver");
  Model fast = model(CellKind::tet10, Formulation::mixed, 0.3);
  fast.settings.integrator = Integrator::central_difference;
  expect_refused(fast, "explicit");
  for (const Formulation formulation : {Formulation::standard, Formulation::fbar}) {
    Model rubber = model(CellKind::tet4, formulation, 0.3);
    rubber.regions[0].law = incompressible_rubber();
    expect_refused(rubber, "incompressible");
  }
}

}  // namespace
}  // namespace msml::fe
