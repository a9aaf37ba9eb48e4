// SPDX-License-Identifier: GPL-3.0-or-later
// Viscoelasticity with every formulation: closed forms, derivatives, energies, and agreement with standard elements.
#include <gtest/gtest.h>

#include "solver/elements/assembly.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"
#include "tests/solver/relaxation.hpp"

namespace msml::fe {
namespace {

using namespace testing;

const Prony two_terms{.g = {0.3, 0.2}, .tau = {0.1, 1}};

/// An element kind beside the standard ones in space and plane strain.
struct Way {
  const char* name;
  CellKind kind;
  Formulation formulation;
  Plane plane = Plane::strain;
};
const Way ways[] = {{"mixed", CellKind::tet10, Formulation::mixed},
                    {"fbar", CellKind::tet4, Formulation::fbar},
                    {"singleRotation", CellKind::tet10, Formulation::single_rotation},
                    {"tri3 stress", CellKind::tri3, Formulation::standard, Plane::stress},
                    {"tri6 stress", CellKind::tri6, Formulation::standard, Plane::stress}};

Model viscous_model(const Way& way, Mesh mesh, const LinearElastic& material) {
  Model model = make_model(std::move(mesh), material);
  model.formulation = way.formulation;
  model.plane = way.plane;
  model.regions[0].prony = two_terms;
  model.settings.integrator = Integrator::quasi_static;
  return model;
}

std::vector<std::shared_ptr<const Law>> laws_for(const Way& way) {
  if (way.formulation == Formulation::single_rotation) return {make_linear_elastic({.youngs_modulus = 1000})};
  return {make_linear_elastic({.youngs_modulus = 1000}),
          make_linear_elastic({.youngs_modulus = 1000, .strain = Strain::small}),
          law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}})};
}

/// Some displacement of all nodes that is no rigid motion, and some pressures.
Vector deformed(const Elements& elements, double size) {
  const Numbering& numbering = elements.numbering();
  Vector u = to_vector(numbering, numbering.mesh->points);
  for (Eigen::Index k = 0; k < u.size(); ++k)
    u[k] = k % 3 < numbering.components ? size * std::sin(1 + 2.0 * u[k] + 0.7 * static_cast<double>(k)) : 0;
  return u;
}

// S = G(t) S_e while u, and with mixed elements the elastic pressure, stay.
TEST(PronyElements, RelaxAsTheSeriesSays) {
  for (const Way& way : ways)
    for (const auto& law : laws_for(way)) {
      Model model = viscous_model(way, unit_mesh(1, way.kind), {});
      model.regions[0].law = law;
      const auto elements = make_elements(model);
      const Vector u = deformed(*elements, 0.05);
      expect_relaxation(*elements, u, way.name + (" " + law->name()));
    }
}

TEST(PronyElements, HaveTheTangentOfTheirForces) {
  for (const Way& way : ways)
    for (const auto& law : laws_for(way)) {
      Model model = viscous_model(way, unit_mesh(1, way.kind), {});
      model.regions[0].law = law;
      const auto elements = make_elements(model);
      const Vector first = deformed(*elements, 0.1), u = 0.5 * first + deformed(*elements, -0.03).reverse();
      elements->begin_step(0.05);
      elements->end_step(first);
      elements->begin_step(0.2);
      BlockMatrix K(elements->pattern());
      Vector force = Vector::Zero(u.size()), column;
      elements->add_internal(u, Want::tangent, force, &K);
      const double h = 1e-6, scale = force.norm();
      for (Eigen::Index k = 0; k < u.size(); ++k) {
        if (k % 3 >= elements->numbering().components) continue;
        const Slopes slopes = slopes_along(*elements, u, k, h);
        EXPECT_NEAR(force[k], slopes.energy, 1e-8 * scale) << way.name << " " << law->name();  // round-off over h
        multiply(K, Vector::Unit(u.size(), k), column);
        EXPECT_LT((column - slopes.force).norm(), 1e-6 * (column.norm() + 1e-3 * scale))
            << way.name << " " << law->name();
      }
    }
}

/// All nodes moved by F - I at once, then held for ten steps of 0.1.
std::vector<State> jump_and_hold(Model& model, const Mat3& F) {
  Prescribed all{.name = "all", .ramp = Ramp::step};
  for (int n = 0; n < model.mesh->point_count(); ++n) {
    all.nodes.push_back(n);
    all.values.push_back((F - Mat3::Identity()) * model.mesh->points.row(n).transpose());
  }
  model.steps = {{.name = "jump", .dt = 1e-10, .count = 1, .gravity = Vec3::Zero(), .prescribed = {all}},
                 {.name = "hold", .dt = 0.1, .count = 10, .gravity = Vec3::Zero(), .prescribed = {all}}};
  std::vector<State> states;
  const Outcome outcome = solve(model, [&](const State& state) {
    states.push_back(state);
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_EQ(states.size(), 12u);
  return states;
}

// W of Hooke's law with E = 1000, nu = 0.3 at strains of 0.01 and -0.02; each spring keeps exp(-2 t / tau) of its
// share.
TEST(PronyElements, StoreAndDissipateWhatMaxwellsSpringsDo) {
  for (const Way& way : ways) {
    const bool small = way.formulation != Formulation::single_rotation;
    Model model = viscous_model(way, unit_mesh(1, way.kind),
                                {.youngs_modulus = 1000, .strain = small ? Strain::small : Strain::corotated});
    const auto states = jump_and_hold(model, Vec3(1.01, 0.98, 1).asDiagonal());
    const double lambda = 1000 * 0.3 / (1.3 * 0.4), mu = 1000 / 2.6, a = 0.01, b = -0.02;
    const double plane = 1000 / (1 - 0.09) * (0.5 * (a * a + b * b) + 0.3 * a * b);
    const double W = way.plane == Plane::stress ? plane : mu * (a * a + b * b) + 0.5 * lambda * (a + b) * (a + b);
    for (std::size_t k = 1; k < states.size(); ++k) {
      const double t = 0.1 * static_cast<double>(k - 1);
      const double stored = W * (0.5 + 0.3 * std::exp(-2 * t / 0.1) + 0.2 * std::exp(-2 * t / 1));
      // The jump takes 1e-9 of the shortest time.
      EXPECT_NEAR(states[k].energies.elastic, stored, 1e-8 * W) << way.name << k;
      EXPECT_NEAR(states[k].energies.dissipated, W - stored, 1e-8 * W) << way.name << k;
      EXPECT_NEAR(states[k].energies.external_work, W, 1e-8 * W) << way.name << k;
      // Results of singleRotation come from the law at points, which there is quadratic in U - I, not in E.
      const double tolerance = small ? 1e-8 : 0.02;
      for (const double density : element_results(model, states[k]).energy_density)
        EXPECT_NEAR(density, stored, tolerance * W) << way.name;
    }
  }
}

// A strain that grows at a constant rate: spring i holds h = g tau (1 - exp(-t/tau)) of the stress S_1 of the whole
// strain, and its dashpot takes h^2/(g tau), which comes to 2 W g tau (T - 2 tau (1 - exp(-T/tau)) + tau/2 (1 - exp(-2
// T/tau))).
TEST(PronyElements, LoseEnergyAtTheRateOfMaxwellsDashpotsToSecondOrder) {
  double lost = 0;  // of 2 W
  for (const auto& [g, tau] : {std::pair{0.3, 0.1}, std::pair{0.2, 1.0}})
    lost += g * tau * (1 + 2 * tau * std::expm1(-1 / tau) - tau / 2 * std::expm1(-2 / tau));
  for (const Way& way : ways) {
    double errors[2];
    for (const int fine : {0, 1}) {
      Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000});
      Prescribed all{.name = "all"};
      for (int n = 0; n < model.mesh->point_count(); ++n) {
        all.nodes.push_back(n);
        const Vec3 X = model.mesh->points.row(n).transpose();
        all.values.push_back(1e-7 * Vec3(X[0], -2 * X[1], 0));  // so small that the corotated law is linear
      }
      const int count = fine ? 80 : 40;
      model.steps = {{.name = "pull", .dt = 1.0 / count, .count = count, .gravity = Vec3::Zero(), .prescribed = {all}}};
      const Outcome outcome = solve(model, {});
      ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
      const double lambda = 1000 * 0.3 / (1.3 * 0.4), mu = 1000 / 2.6, a = 1e-7, b = -2e-7;
      const double W = way.plane == Plane::stress ? 1000 / 0.91 * (0.5 * (a * a + b * b) + 0.3 * a * b)
                                                  : mu * (a * a + b * b) + 0.5 * lambda * (a + b) * (a + b);
      errors[fine] = std::abs(outcome.state.energies.dissipated / (2 * W) - lost) / lost;
    }
    EXPECT_LT(errors[1], 1e-2) << way.name;
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.2) << way.name;
  }
}

// Stress and pressure at 5 % and more of strain, where S, P and the Cauchy stress differ.
TEST(PronyElements, ResultsRelaxWithTheForces) {
  for (const Way& way : ways) {
    Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000});
    if (way.formulation != Formulation::single_rotation) model.regions[0].law = laws_for(way).back();
    const auto states = jump_and_hold(model, Vec3(1.2, 0.95, way.plane == Plane::stress ? 1 : 0.97).asDiagonal());
    const auto stress = [&](std::size_t k) { return element_results(model, states[k]).cauchy[0]; };
    EXPECT_GT(stress(1), 100) << way.name;
    EXPECT_NEAR(stress(2) / stress(1), .79133132, 1e-8) << way.name;
    EXPECT_NEAR(stress(11) / stress(1), .57358951, 1e-8) << way.name;
    if (way.formulation != Formulation::mixed) continue;
    EXPECT_NEAR(states[2].pressure[0] / states[1].pressure[0], .79133132, 1e-8);
    EXPECT_NEAR(states[11].pressure[0] / states[1].pressure[0], .57358951, 1e-8);
    Model plain = model;
    plain.regions[0].prony = {};
    const auto elastic = jump_and_hold(plain, Vec3(1.2, 0.95, 0.97).asDiagonal());
    EXPECT_NEAR(states[1].pressure[0], elastic[1].pressure[0], 1e-7 * std::abs(elastic[1].pressure[0]));
  }
}

/// One term with g and tau of the element's own, or of the place.
Prony of_element(int e, const Vec3&) { return {.g = {0.2 + 0.05 * e}, .tau = {0.1 * (1 + e)}}; }
Prony of_place(int, const Vec3& X) { return {.g = {0.2 + 0.3 * X[0]}, .tau = {0.1 * (1 + X[1])}}; }

/// Side by side, laws of 1000 times G(t) of the series at each place.
std::shared_ptr<const Law> relaxed(double t, const std::vector<Prony>& series) {
  std::vector<std::shared_ptr<const Law>> laws;
  for (const Prony& own : series)
    laws.push_back(make_linear_elastic({.youngs_modulus = 1000 * (1 - own.g[0] * (1 - std::exp(-t / own.tau[0])))}));
  laws.resize(lanes, laws.back());
  return laws.front()->merged(laws);
}

// Held, a body whose series differs from place to place is one whose stiffness does: E G(X, t). With mixed elements
// this is so while the pressure is none, and patches take the mean of g, here with one tau.
TEST(PronyElements, MayDifferFromPlaceToPlace) {
  std::vector<Way> all(std::begin(ways), std::end(ways));
  for (const CellKind kind : every_kind) all.push_back({name(kind), kind, Formulation::standard});
  for (const Way& way : all)
    for (const bool inside : {false, true}) {
      if (way.formulation == Formulation::single_rotation && inside) continue;  // takes the middle of each
      Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000}), held = model;
      Region &region = model.regions[0], &elastic = held.regions[0];
      region.prony_at = inside ? of_place : of_element;
      region.prony = region.prony_at(0, Vec3::Zero());
      const double t = 0.3;
      elastic.prony = {};
      const auto at = region.prony_at;
      elastic.point_law = [=](std::span<const int> elements, std::span<const Vec3> places) {
        std::vector<Prony> series;
        for (std::size_t k = 0; k < places.size(); ++k)
          series.push_back(at(elements[std::min(k, elements.size() - 1)], places[k]));
        return relaxed(t, series);
      };
      if (way.formulation == Formulation::fbar) {
        region.prony_at = [](int e, const Vec3&) -> Prony { return {.g = {0.2 + 0.05 * e}, .tau = {0.1}}; };
        elastic.point_law = [=](std::span<const int>, std::span<const Vec3>) {
          return relaxed(t, {{.g = {0.2 + 0.05 * 2.5}, .tau = {0.1}}});  // six elements of one volume
        };
      }
      const auto elements = make_elements(model), plain = make_elements(held);
      Vector u = deformed(*elements, 0.05);
      u.tail(u.size() - 3 * elements->numbering().body_nodes()).setZero();
      elements->begin_step(0);
      elements->end_step(u);
      elements->begin_step(t);
      const Vector wanted = force_at(*plain, u);
      // The corotated stress is a second Piola one up to the stretch, which both have alike.
      EXPECT_LT((force_at(*elements, u) - wanted).norm(), 1e-12 * wanted.norm()) << way.name << inside;
      EXPECT_GT((force_at(*elements, 0.5 * u) - 0.5 * wanted).norm(), 1e-2 * wanted.norm()) << way.name << inside;
    }
}

// A term of 0 takes no part in forces or in the energy that is stored, beside one that does.
TEST(PronyElements, ATermOfZeroDoesNotAct) {
  std::vector<Way> all(std::begin(ways), std::end(ways));
  for (const CellKind kind : every_kind) all.push_back({name(kind), kind, Formulation::standard});
  for (const Way& way : all) {
    Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000}), less = model;
    model.regions[0].prony = {.g = {0.3, 0}, .tau = {0.1, 1}, .long_term = true};
    less.regions[0].prony = {.g = {0.3}, .tau = {0.1}, .long_term = true};
    const auto elements = make_elements(model), fewer = make_elements(less);
    const Vector u = deformed(*elements, 0.05);
    for (const double dt : {0.0, 0.04, 0.2}) {
      elements->begin_step(dt), fewer->begin_step(dt);
      const Vector wanted = force_at(*fewer, u);
      EXPECT_LT((force_at(*elements, u) - wanted).norm(), 1e-14 * wanted.norm()) << way.name;
      elements->end_step(u), fewer->end_step(u);
    }
    const auto stored = elements->history_energy(), expected = fewer->history_energy();
    ASSERT_TRUE(stored && expected) << way.name;
    for (std::size_t q = 0; q < stored->size(); ++q)
      EXPECT_NEAR((*stored)[q], (*expected)[q], 1e-14 * std::abs((*expected)[q])) << way.name;
  }
}

// Held where it begins, a body has the stress of the law first, with its pressure, which then relaxes as G(t).
TEST(PronyElements, RelaxFromAnInitialDisplacement) {
  for (const Way& way : ways)
    for (const Integrator integrator : {Integrator::quasi_static, Integrator::implicit_euler, Integrator::newmark}) {
      Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000});
      model.settings.integrator = integrator;
      model.initial_displacement = 0.01 * model.mesh->points;
      Prescribed held{.name = "held", .nodes = points_where(*model.mesh, [](const Vec3&) { return true; })};
      for (const int n : held.nodes) held.values.push_back(model.initial_displacement.row(n).transpose());
      model.steps[0] = {.name = "hold", .dt = 0.05, .count = 4, .gravity = Vec3::Zero(), .prescribed = {held}};
      // Strain e in two or three directions; the corotated stress is 1 / 1.01 (space) of it as F S F^T / J.
      const double elastic = way.plane == Plane::stress ? 0.01 * 1000 / 0.7 : 0.01 * 1000 / 0.4;
      double first = 0;
      const Outcome outcome = solve(model, [&](const State& state) {
        const double t = state.time, share = 0.5 + 0.3 * std::exp(-t / 0.1) + 0.2 * std::exp(-t);
        const double stress = element_results(model, state).cauchy[0];
        if (t == 0) {
          EXPECT_NEAR(stress, elastic, 0.025 * elastic) << way.name;
          first = stress;
        }
        EXPECT_NEAR(stress, share * first, 1e-9 * elastic) << way.name << " " << name(integrator) << " at " << t;
        return true;
      });
      EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    }
}

/// A block pulled to a stretch at once, free at its sides; reactions in x, over the area of 1.
std::vector<double> pulled(Model& model, double stretch) {
  const Mesh& mesh = *model.mesh;
  const auto at = [&](int axis, double value) {
    return points_where(mesh, [=](const Vec3& x) { return std::abs(x[axis] - value) < 1e-9; });
  };
  Prescribed pull{.name = "pull", .nodes = at(0, 1), .values = {Vec3(stretch - 1, 0, 0)}, .ramp = Ramp::step};
  pull.components[1] = pull.components[2] = false;
  const std::vector<Prescribed> held{fix(at(0, 0), true, false, false), fix(at(1, 0), false, true, false),
                                     fix(at(2, 0), false, false, true), pull};
  model.steps = {{.name = "jump", .dt = 1e-10, .count = 1, .gravity = Vec3::Zero(), .prescribed = held},
                 {.name = "hold", .dt = 0.1, .count = 10, .gravity = Vec3::Zero(), .prescribed = held}};
  std::vector<double> forces;
  const Outcome outcome = solve(model, [&](const State& state) {
    double sum = 0;
    for (const int n : pull.nodes) sum += state.reaction(n, 0);
    forces.push_back(sum);
    return true;
  });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return forces;
}

// The lateral stress is zero at all times, which makes that of the elastic law zero too: P = G(t) mu (s - 1/s^2) of the
// incompressible neo-Hookean block (mu = 1), and in the plane, where nu = 0.3, the stress of the elastic one times
// G(t).
TEST(PronyElements, AStretchedBlockRelaxes) {
  for (const Way& way : ways) {
    Model model = viscous_model(way, unit_mesh(1, way.kind), {.youngs_modulus = 1000});
    if (way.formulation == Formulation::mixed)
      model.regions[0].law = law_of("neoHookeanMaterial", {{"youngModulus", 3.0},
                                                           {"poissonRatio", Value{}},
                                                           {"form", std::string("isochoric")},
                                                           {"incompressible", true}});
    const auto forces = pulled(model, 1.5);
    ASSERT_EQ(forces.size(), 12u) << way.name;
    if (way.formulation == Formulation::mixed) {
      EXPECT_NEAR(forces[1], 1.5 - 1 / 2.25, 1e-7);
    }
    EXPECT_NEAR(forces[2] / forces[1], .79133132, 1e-7) << way.name;
    EXPECT_NEAR(forces[11] / forces[1], .57358951, 1e-7) << way.name;
  }
}

/// Deflection of the tip of a cantilever under gravity that acts from the start, after ten steps of 0.1.
double sag(const Way& way, int n, const std::shared_ptr<const Law>& law) {
  Model model = viscous_model(way, box_mesh(3 * n, n, n, {3, 1, 1}, way.kind), {});
  model.regions[0].law = law;
  model.settings.integrator = Integrator::quasi_static;
  const auto wall = fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }));
  model.steps = {{.name = "sag", .dt = 0.1, .count = 10, .gravity = Vec3(0, 0, -6), .prescribed = {wall}}};
  const int tip = nearest_point(*model.mesh, {3, 0.5, 0.5});
  const Outcome outcome = solve(model, [](const State&) { return true; });
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return outcome.state.displacement(tip, 2);
}

TEST(PronyElements, BendAsStandardOnesDo) {
  const Way standard{"standard", CellKind::tet10, Formulation::standard};
  const auto rubber = law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
  const double coarse = sag(standard, 1, rubber), fine = sag(standard, 2, rubber);
  const double difference = std::abs(sag(ways[0], 1, rubber) / coarse - 1);
  const double finer = std::abs(sag(ways[0], 2, rubber) / fine - 1);
  EXPECT_LT(coarse, -0.5);
  EXPECT_LT(difference, 0.02);
  EXPECT_LT(finer, 0.5 * difference);
  // tet10SR is the corotated law where elements turn and strain little: 2 % of them at their largest here.
  const auto linear = make_linear_elastic({.youngs_modulus = 1000});
  EXPECT_NEAR(sag(ways[2], 2, linear) / sag(standard, 2, linear), 1, 0.02);
  // Linear tetrahedra are too stiff in bending by the square of their size: four through the height, an eighth of it.
  EXPECT_NEAR(sag(ways[1], 4, rubber) / fine, 1, 0.15);
}

}  // namespace
}  // namespace msml::fe
