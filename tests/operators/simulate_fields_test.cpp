// SPDX-License-Identifier: GPL-3.0-or-later
// Fields that depend on the law and the formulation: fibre stretch, pressure as an unknown.
#include <gtest/gtest.h>

#include <numeric>

#include "tests/operators/simulate_scene.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::test {
namespace {

Record of_region(const Language& language, const MeshPtr& mesh, std::vector<Record> parts) {
  std::vector<int> all(static_cast<std::size_t>(mesh->cell_count()));
  std::iota(all.begin(), all.end(), 0);
  return language.tag("region", "region", {{"indices", index_set(mesh, Indexed::elements, all)}}, std::move(parts));
}

/// The unit cube of a mesh tag and a material between rollers, its top moved by 0.2 along z and free across.
Scene stretched(const Language& language, const MeshPtr& mesh, const Record& tag, const Record& material,
                const Record& probe) {
  Scene scene = pulled(language, probe);
  scene.mesh = mesh;
  scene.mesh_tag = tag;
  scene.regions = {of_region(language, mesh, {material})};
  scene.constraints.clear();
  for (int k = 0; k < 3; ++k) {
    Numbers normal{0, 0, 0};
    normal[static_cast<std::size_t>(k)] = 1;
    scene.constraints.push_back(
        condition(language, "symmetryPlane", {{"indices", points_at(mesh, k, 0)}, {"normal", normal}}));
  }
  scene.constraints.push_back(condition(
      language, "displacementConstraint",
      {{"indices", points_at(mesh, 2, 1)}, {"displacement", Numbers{0, 0, 0.2}}, {"components", Words{"z"}}}));
  return scene;
}

Record probe_of(const Language& language, const std::string& field) {
  return language.tag("probe", "output",
                      {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}, {"field", field}});
}

TEST(FiberStretch, IsTheStretchAlongTheFibres) {
  const Language language;
  const Record material =
      language.tag("transverselyIsotropicMaterial", "material",
                   {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}, {"k1", 100.0}, {"fiber", std::string("0 0 3")}});
  const MeshPtr mesh = std::make_shared<const Mesh>(box(1, 1, 1));
  for (const char* field : {"fiberStretch", "fiberStretch_nodal"}) {
    const Scene scene = stretched(language, mesh, language.tag("linearTet", "mesh", {{"mesh", mesh}}), material,
                                  probe_of(language, field));
    const std::string csv = written(language, scene, "p.csv");
    EXPECT_NEAR(csv_rows(csv)[0][1], 1, 1e-12);
    EXPECT_NEAR(csv_rows(csv)[1][1], 1.1, 1e-9);
    EXPECT_NEAR(csv_rows(csv)[2][1], 1.2, 1e-9);
  }
}

TEST(FiberStretch, IsOneWithoutFibres) {
  const Language language;
  const std::string csv = written(language, pulled(language, probe_of(language, "fiberStretch")), "p.csv");
  EXPECT_EQ(csv_rows(csv).back()[1], 1);
}

// Incompressible neo-Hookean rubber pulled to L: Cauchy stress mu (L^2 - 1/L), whose deviator is that of the isochoric
// energy, so that the pressure is minus a third of it. mu = 1000 / 3.
TEST(Pressure, OfMixedElementsIsTheUnknownAtNodes) {
  const Language language;
  const MeshPtr mesh = std::make_shared<const Mesh>(fe::testing::box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet10));
  Scene scene = stretched(
      language, mesh, language.tag("quadraticTet", "mesh", {{"mesh", mesh}, {"formulation", std::string("mixed")}}),
      language.tag("neoHookeanMaterial", "material",
                   {{"youngModulus", 1000.0}, {"form", std::string("isochoric")}, {"incompressible", true}}),
      probe_of(language, "pressure"));
  const double expected = -1000.0 / 3 * (1.2 * 1.2 - 1 / 1.2) / 3;
  EXPECT_NEAR(csv_rows(written(language, scene, "p.csv")).back()[1], expected, 1e-5 * std::abs(expected));
  scene.outputs = {language.tag("probe", "output",
                                {{"id", std::string("p")},
                                 {"indices", index_set(nullptr, Indexed::nodes, {0, 1})},
                                 {"field", std::string("pressure")}})};
  const Numbers last = csv_rows(written(language, scene, "p.csv")).back();
  EXPECT_NEAR(last[1], expected, 1e-5 * std::abs(expected));  // a corner
  EXPECT_NEAR(last[2], expected, 1e-5 * std::abs(expected));  // a mid node
}

// Two rubbers side by side, glued at x = 0.5 and pulled to L together: both grow thinner alike, and each has its own
// pressure up to the other, -mu (L^2 - 1/L) / 3.
TEST(Pressure, AtAPointIsThatOfTheRegionAroundIt) {
  const Language language;
  const MeshPtr mesh = std::make_shared<const Mesh>(fe::testing::box_mesh(2, 1, 1, {1, 1, 1}, CellKind::tet10));
  std::vector<int> sides[2];
  for (int cell = 0; cell < mesh->cell_count(); ++cell) {
    double middle = 0;
    for (int a = 0; a < 4; ++a) middle += mesh->points(mesh->cell(cell)[a], 0) / 4;
    sides[middle > 0.5].push_back(cell);
  }
  const double young[2] = {1000, 4000};
  for (const char* field : {"pressure", "pressure_nodal"})
    for (const int side : {0, 1}) {
      Scene scene =
          stretched(language, mesh,
                    language.tag("quadraticTet", "mesh", {{"mesh", mesh}, {"formulation", std::string("mixed")}}), {},
                    language.tag("probe", "output",
                                 {{"id", std::string("p")},
                                  {"point", Numbers{0.45 + 0.1 * side, 0.6, 0.7}},
                                  {"field", std::string(field)}}));
      scene.regions.clear();
      for (const int k : {0, 1})
        scene.regions.push_back(language.tag(
            "region", "region", {{"indices", index_set(mesh, Indexed::elements, sides[k])}},
            {language.tag(
                "neoHookeanMaterial", "material",
                {{"youngModulus", young[k]}, {"form", std::string("isochoric")}, {"incompressible", true}})}));
      const double expected = -young[side] / 3 * (1.2 * 1.2 - 1 / 1.2) / 3;
      EXPECT_NEAR(csv_rows(written(language, scene, "p.csv")).back()[1], expected, 1e-6 * std::abs(expected)) << field;
    }
}

// A block between walls under gravity does not move, whatever it is: its pressure is that of water, rho g (1 - z).
TEST(Pressure, AtAPointIsLinearInEachElement) {
  const Language language;
  const MeshPtr mesh = std::make_shared<const Mesh>(fe::testing::box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet10));
  for (const Numbers& point : {Numbers{0.3, 0.6, 0.7}, Numbers{0.8, 0.1, 0.2}, Numbers{0.5, 0.5, 0.5}}) {
    Scene scene =
        stretched(language, mesh,
                  language.tag("quadraticTet", "mesh", {{"mesh", mesh}, {"formulation", std::string("mixed")}}), {},
                  language.tag("probe", "output",
                               {{"id", std::string("p")}, {"point", point}, {"field", std::string("pressure")}}));
    scene.regions = {of_region(
        language, mesh,
        {language.tag("neoHookeanMaterial", "material",
                      {{"youngModulus", 1000.0}, {"form", std::string("isochoric")}, {"incompressible", true}}),
         language.tag("mass", "mass", {{"massDensity", 2.0}})})};
    scene.constraints.pop_back();
    for (int axis : {0, 1}) {
      Numbers normal{0, 0, 0};
      normal[static_cast<std::size_t>(axis)] = 1;
      scene.constraints.push_back(
          condition(language, "symmetryPlane", {{"indices", points_at(mesh, axis, 1)}, {"normal", normal}}));
    }
    scene.steps = {language.tag("step", "step", {{"gravity", Numbers{0, 0, -10}}})};
    const double expected = 20 * (1 - point[2]);
    EXPECT_NEAR(csv_rows(written(language, scene, "p.csv")).back()[1], expected, 1e-9 * 20);
  }
}

}  // namespace
}  // namespace msml::test
