// SPDX-License-Identifier: GPL-3.0-or-later
// Viscoelastic stresses against the convolution integral.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msml/core/error.hpp"
#include "solver/elements/assembly.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"
#include "tests/solver/relaxation.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

const Prony two_terms{.g = {0.3, 0.2}, .tau = {0.1, 1}};

Model prony_model(CellKind kind, Strain strain) {
  Model model = make_model(unit_mesh(1, kind), {.youngs_modulus = 1000, .strain = strain});
  model.regions[0].prony = two_terms;
  return model;
}

/// Some displacement of all nodes that is no rigid motion.
Vector deformed(const Elements& elements, const Model& model, double size) {
  Vector u = to_vector(elements.numbering(), model.mesh->points);
  for (Eigen::Index k = 0; k < u.size(); ++k)
    u[k] = k % 3 < elements.numbering().components ? size * std::sin(1 + 2.0 * u[k] + 0.7 * static_cast<double>(k)) : 0;
  return u;
}

// Relaxation after a step strain is G(t), whatever the time steps and the law: S = G(t) S_e while F stays.
TEST(Prony, RelaxesAsTheSeriesSays) {
  for (const CellKind kind : every_kind)
    for (const Strain strain : {Strain::small, Strain::corotated}) {
      const Model model = prony_model(kind, strain);
      const auto elements = make_elements(model);
      const Vector u = deformed(*elements, model, 0.05);
      expect_relaxation(*elements, u, name(kind));
    }
}

// Held where it begins, a body has the instantaneous stress first, that of the law itself, which then relaxes as G(t).
TEST(Prony, RelaxesFromAnInitialDisplacement) {
  for (const Integrator integrator :
       {Integrator::quasi_static, Integrator::implicit_euler, Integrator::newmark, Integrator::generalized_alpha}) {
    Model model = prony_model(CellKind::tet10, Strain::small);
    model.settings.integrator = integrator;
    model.initial_displacement = 0.01 * model.mesh->points;
    Prescribed held{.name = "held", .nodes = points_where(*model.mesh, [](const Vec3&) { return true; })};
    for (const int n : held.nodes) held.values.push_back(model.initial_displacement.row(n).transpose());
    model.steps[0] = {.name = "hold", .dt = 0.05, .count = 4, .gravity = Vec3::Zero(), .prescribed = {held}};
    const Outcome outcome = solve(model, [&](const State& state) {
      const double t = state.time, share = 0.5 + 0.3 * std::exp(-t / 0.1) + 0.2 * std::exp(-t);
      const double wanted = share * 0.01 * 1000 / (1 - 2 * 0.3);  // 3 k e with a strain of e in all directions
      EXPECT_THAT(element_results(model, state).cauchy[0], ::testing::DoubleNear(wanted, 1e-9 * wanted))
          << name(integrator) << " at " << t;
      return true;
    });
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  }
}

TEST(Prony, InstantaneousAndLongTermLawsAreThoseGiven) {
  Model model = prony_model(CellKind::tet10, Strain::corotated);
  model.regions[0].prony.long_term = true;
  Model plain = prony_model(CellKind::tet10, Strain::corotated);
  plain.regions[0].prony = {};
  const auto elements = make_elements(model), elastic = make_elements(plain);
  const Vector u = deformed(*elements, model, 0.05), wanted = force_at(*elastic, u);
  elements->begin_step(0);
  EXPECT_LT((force_at(*elements, u) - 2 * wanted).norm(), 1e-12 * wanted.norm());
  elements->end_step(u);
  elements->begin_step(1e3);
  EXPECT_LT((force_at(*elements, u) - wanted).norm(), 1e-12 * wanted.norm());
}

// Under a strain that grows at a constant rate the stress is rate * (g_inf t + sum g_i tau_i (1 - exp(-t / tau_i))).
TEST(Prony, FollowsAConstantStrainRateExactly) {
  const Model model = prony_model(CellKind::tri6, Strain::small);
  const auto elements = make_elements(model);
  const Vector u = deformed(*elements, model, 0.05);
  const Vector elastic = force_at(*elements, u);  // dt = 0
  double t = 0;
  for (const double dt : {0.02, 0.2, 0.05, 0.4}) {
    t += dt;
    elements->begin_step(dt);
    const Vector force = force_at(*elements, t * u);
    elements->end_step(t * u);
    double share = 0.5 * t;
    for (int i = 0; i < 2; ++i) {
      const double g = two_terms.g[static_cast<std::size_t>(i)], tau = two_terms.tau[static_cast<std::size_t>(i)];
      share += g * tau * (1 - std::exp(-t / tau));
    }
    EXPECT_LT((force - share * elastic).norm(), 1e-13 * elastic.norm());
  }
}

TEST(Prony, ForceIsDerivativeOfEnergyAndTangentOfForce) {
  for (const Strain strain : {Strain::small, Strain::corotated}) {
    const Model model = prony_model(CellKind::tet4, strain);
    const auto elements = make_elements(model);
    const Vector first = deformed(*elements, model, 0.1), u = 0.5 * first + deformed(*elements, model, -0.03).reverse();
    elements->begin_step(0.05);
    elements->end_step(first);
    elements->begin_step(0.2);
    BlockMatrix K(elements->pattern());
    Vector force = Vector::Zero(u.size()), column;
    elements->add_internal(u, Want::tangent, force, &K);
    const double h = 1e-6;
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      const Slopes slopes = slopes_along(*elements, u, k, h);
      EXPECT_NEAR(force[k], slopes.energy, 1e-6);  // round-off of an energy of about 10, over h
      multiply(K, Vector::Unit(u.size(), k), column);
      EXPECT_LT((column - slopes.force).norm(), 1e-6 * column.norm());
    }
  }
}

TEST(Prony, ResultsRelaxWithTheForces) {
  Model model = prony_model(CellKind::tet4, Strain::corotated);
  model.settings.integrator = Integrator::quasi_static;
  const Mat3 F = Vec3(1.2, 0.95, 0.97).asDiagonal();
  Prescribed all{.name = "all", .ramp = Ramp::step};
  for (int n = 0; n < model.mesh->point_count(); ++n) {
    all.nodes.push_back(n);
    all.values.push_back((F - Mat3::Identity()) * model.mesh->points.row(n).transpose());
  }
  model.steps = {{.name = "jump", .dt = 1e-10, .count = 1, .gravity = Vec3::Zero(), .prescribed = {all}},
                 {.name = "hold", .dt = 0.1, .count = 10, .gravity = Vec3::Zero(), .prescribed = {all}}};
  std::vector<double> stress;
  solve(model, [&](const State& state) {
    stress.push_back(element_results(model, state).cauchy[0]);
    return true;
  });
  ASSERT_EQ(stress.size(), 12u);
  Measures rest;
  Gradients H{};
  for (int i = 0; i < 3; ++i) H(i, i) = lanes_of(F(i, i) - 1);
  model.regions[0].law->measure({&H, 1}, {&rest, 1});
  // The corotated law writes P R^T as its stress; what remembers has the Cauchy stress P F^T / J. The jump takes 1e-10,
  // 1e-9 of the shortest time.
  EXPECT_NEAR(stress[1], rest.cauchy(0, 0)[0] / (F(1, 1) * F(2, 2)), 1e-6);
  EXPECT_NEAR(stress[2] / stress[1], .79133132, 1e-8);
  EXPECT_NEAR(stress[11] / stress[1], .57358951, 1e-8);
}

// A strain put on at once and held: each term's spring lets go as exp(-t/tau), its energy as exp(-2 t/tau), and what is
// not stored is dissipated, as nothing does work any more.
TEST(Prony, AHeldStrainStoresTheEnergyOfMaxwellsSprings) {
  for (const Strain strain : {Strain::small, Strain::corotated}) {
    Model model = prony_model(CellKind::tet4, strain);
    model.settings.integrator = Integrator::quasi_static;
    Prescribed all{.name = "all", .ramp = Ramp::step};
    for (int n = 0; n < model.mesh->point_count(); ++n) {
      all.nodes.push_back(n);
      all.values.push_back(Vec3(0.01 * model.mesh->points(n, 0), 0, -0.02 * model.mesh->points(n, 2)));
    }
    model.steps = {{.name = "jump", .dt = 1e-10, .count = 1, .gravity = Vec3::Zero(), .prescribed = {all}},
                   {.name = "hold", .dt = 0.1, .count = 10, .gravity = Vec3::Zero(), .prescribed = {all}}};
    std::vector<State> states;
    solve(model, [&](const State& state) {
      states.push_back(state);
      return true;
    });
    ASSERT_EQ(states.size(), 12u);
    const double lambda = 1000 * 0.3 / (1.3 * 0.4), mu = 1000 / 2.6;
    const double W = mu * (0.01 * 0.01 + 0.02 * 0.02) + 0.5 * lambda * 0.01 * 0.01;  // of the unit cube
    for (std::size_t k = 1; k < 12; ++k) {
      const double t = 0.1 * static_cast<double>(k - 1);
      const double stored = W * (0.5 + 0.3 * std::exp(-2 * t / 0.1) + 0.2 * std::exp(-2 * t / 1));
      // The jump takes 1e-9 of the shortest time. The corotated stress is linear in U - I but not in E: its work over
      // the jump is W to the order of the strain, 0.02.
      const double tolerance = strain == Strain::small ? 1e-8 : 0.02;
      EXPECT_NEAR(states[k].energies.elastic, stored, 1e-8 * W) << k;
      EXPECT_NEAR(states[k].energies.dissipated, W - stored, tolerance * W) << k;
      EXPECT_NEAR(states[k].energies.external_work, W, tolerance * W) << k;
      const ElementResults results = element_results(model, states[k]);
      for (const double density : results.energy_density) EXPECT_NEAR(density, stored, 1e-8 * W);
    }
  }
}

TEST(Prony, IsRefusedOutsideItsRange) {
  Model model = prony_model(CellKind::tet4, Strain::corotated);
  model.steps[0].prescribed = {fix({0, 1, 2, 3})};
  const auto refusal = [&](const Prony& prony) -> std::string {
    model.regions[0].prony = prony;
    try {
      model.check();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(two_terms), "");
  EXPECT_THAT(refusal({.g = {0.3, 0.8}, .tau = {1, 2}}), HasSubstr("the sum of g = 1.1 is not < 1"));
  EXPECT_EQ(refusal({.g = {0.3, 0}, .tau = {1, 2}}), "");
  EXPECT_THAT(refusal({.g = {-0.3}, .tau = {1}}), HasSubstr("g = -0.3 is not >= 0"));
  EXPECT_THAT(refusal({.g = {0.3}, .tau = {0}}), HasSubstr("tau = 0 is not > 0"));
  EXPECT_THAT(refusal({.g = {0.3}, .tau = {1, 2}}), HasSubstr("one of each per term"));
}

}  // namespace
}  // namespace msml::fe
