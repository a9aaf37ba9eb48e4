// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar problems on every element.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msml/core/error.hpp"
#include "solver/materials/diffusion.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

Model heat_model(CellKind kind, double c) {
  Model model = make_model(unit_mesh(2, kind), {});
  model.regions[0].law = make_diffusion(c);
  return model;
}

TEST(Diffusion, FluxIsDerivativeOfEnergyAndTangentOfFlux) {
  const auto law = make_diffusion(2.5);
  Random random;
  const Mat3 F = random.matrix(), direction = random.matrix();
  const double h = 1e-5;
  const Point up = evaluate(*law, F + h * direction), down = evaluate(*law, F - h * direction), at = evaluate(*law, F);
  EXPECT_NEAR(at.P.cwiseProduct(direction).sum(), (up.energy - down.energy) / (2 * h), 1e-9);  // W is quadratic
  EXPECT_LT((Mat3(up.P - down.P).row(0) / (2 * h) - 2.5 * direction.row(0)).norm(), 1e-9);
  EXPECT_NEAR(at.tangent.trace(), 3 * 2.5, 1e-15);
  EXPECT_THROW(make_diffusion(0), Error);
}

// u = 3 + x between two held values, or a value and a flux, whatever the element; the flux through the unit side is c.
TEST(Diffusion, IsLinearBetweenTwoSides) {
  for (const CellKind kind : every_kind) {
    Model model = heat_model(kind, 2);
    Prescribed held{.name = "left", .nodes = points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; })};
    held.values = {Vec3(3, 0, 0)};
    model.steps[0].prescribed = {held};
    FaceLoad flux{.name = "flux", .tractions = {Vec3(2, 0, 0)}};
    flux.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
    model.steps[0].face_loads = {flux};
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    for (int n = 0; n < model.mesh->point_count(); ++n) {
      EXPECT_NEAR(outcome.state.displacement(n, 0), 3 + model.mesh->points(n, 0), 1e-12);
      EXPECT_EQ(outcome.state.displacement(n, 1), 0);
      EXPECT_EQ(outcome.state.displacement(n, 2), 0);
    }
    EXPECT_NEAR(outcome.check.sum_reactions[0], -2, 1e-12);
    EXPECT_LT(outcome.check.balance, 1e-12);
    const ElementResults results = element_results(model, outcome.state);
    for (const double energy : results.energy_density) EXPECT_NEAR(energy, 1, 1e-12);  // c/2
    EXPECT_NEAR(outcome.check.smallest_J, 1, 1e-12);
    EXPECT_EQ(outcome.check.volume_change, 0);
  }
}

// Without a held value the loads must add up to nothing; the answer is then fixed up to a constant.
TEST(Diffusion, WithFluxesAloneNeedsThemBalanced) {
  for (const CellKind kind : every_kind) {
    Model model = heat_model(kind, 2);
    FaceLoad in{.name = "in", .tractions = {Vec3(2, 0, 0)}}, out{.name = "out", .tractions = {Vec3(-2, 0, 0)}};
    in.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
    out.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
    model.steps[0].face_loads = {in};
    try {
      solve(model, {});
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("give it a fixedValue, or balance them"), std::string::npos);
    }
    model.steps[0].face_loads = {in, out};
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Points& u = outcome.state.displacement;
    for (int n = 0; n < model.mesh->point_count(); ++n)
      EXPECT_NEAR(u(n, 0) - u(0, 0), model.mesh->points(n, 0) - model.mesh->points(0, 0), 1e-9) << name(kind);
  }
}

TEST(Diffusion, IsStationaryAndNotMixedWithElasticity) {
  Model model = heat_model(CellKind::tet4, 1);
  model.settings.integrator = Integrator::newmark;
  try {
    model.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("a scalar problem (diffusionMaterial) is stationary"));
  }
  model = heat_model(CellKind::tet4, 1);
  Region second{.name = "second", .law = make_linear_elastic({})};
  second.elements.push_back(model.regions[0].elements.back());
  model.regions[0].elements.pop_back();
  model.regions.push_back(second);
  EXPECT_THROW(model.check(), Error);
}

}  // namespace
}  // namespace msml::fe
