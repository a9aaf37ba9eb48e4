// SPDX-License-Identifier: GPL-3.0-or-later
// Plane bodies and lines from record to results, against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "operators/mesh_generators.hpp"
#include "operators/mesh_quadratic.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::operators {
Operator simulate();
}

namespace msml::test {
namespace {

using testing::HasSubstr;

MeshPtr plate(bool quadratic) {
  const Mesh mesh = operators::generate(operators::Rectangle{Vec3::Zero(), 2, 1, {4, 2}});
  return std::make_shared<const Mesh>(quadratic ? operators::to_quadratic(mesh) : mesh);
}

struct Ran {
  Listener listener;
  std::vector<Value> outputs;
};

Ran run(const Language& language, const Scene& scene, const Folder& folder) {
  Ran ran;
  const Record record = scene.record(language);
  Context context(record, ran.listener, folder.path(), 1);
  operators::simulate()(context);
  ran.outputs = context.outputs;
  return ran;
}

std::string fault(const Language& language, const Scene& scene) {
  const Folder folder;
  try {
    run(language, scene, folder);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Cells of one dimension whose points all have coordinate `axis` at the value.
IndexSetPtr cells_at(const MeshPtr& mesh, int dimension, int axis, double value) {
  std::vector<int> ids;
  for (int c = 0; c < mesh->cell_count(); ++c) {
    const CellKind kind = mesh->kinds[static_cast<std::size_t>(c)];
    bool all = msml::dimension(kind) == dimension;
    for (int a = 0; all && a < node_count(kind); ++a)
      all = std::abs(mesh->points(mesh->cell(c)[a], axis) - value) < 1e-9;
    if (all) ids.push_back(c);
  }
  return index_set(mesh, Indexed::faces, ids);
}

/// A plate 2 x 1 on rollers at x = 0 and y = 0, pulled with 10 per area at x = 2.
Scene pulled_plate(const Language& language, const std::string& kind) {
  Scene scene = cube(language);
  scene.mesh_kind = kind;
  scene.mesh = plate(kind == "quadraticTriangle");
  std::vector<int> triangles;
  for (int c = 0; c < scene.mesh->cell_count(); ++c)
    if (dimension(scene.mesh->kinds[static_cast<std::size_t>(c)]) == 2) triangles.push_back(c);
  scene.regions = {region(language, "plate", index_set(scene.mesh, Indexed::elements, triangles), 1000, 0.3, "small")};
  scene.constraints = {
      condition(language, "fixedConstraint",
                {{"indices", points_at(scene.mesh, 0, 0)}, {"components", std::string("x")}}),
      condition(language, "fixedConstraint",
                {{"indices", points_at(scene.mesh, 1, 0)}, {"components", std::string("y")}}),
      condition(language, "surfaceTraction",
                {{"indices", cells_at(scene.mesh, 1, 0, 2)}, {"traction", std::vector<double>{10, 0, 0}}})};
  scene.outputs = {language.tag("result", "output", {{"id", std::string("plate")}})};
  return scene;
}

// Plane strain: e_xx = (1 - nu^2) s/E, e_yy = -nu (1 + nu) s/E.
TEST(SimulatePlane, StrainGivesTheClosedForm) {
  const Language language;
  for (const std::string kind : {"linearTriangle", "quadraticTriangle", "triangularTet"}) {
    const Folder folder;
    const Ran ran = run(language, pulled_plate(language, kind), folder);
    const Mesh& last = *std::get<SeriesPtr>(ran.outputs.at(0))->last;
    // The lower right corner, X = (2, 0), is point 4 of the grid.
    EXPECT_NEAR(last.points(4, 0), 2 * (1 + 0.91 * 0.01), 1e-9) << kind;
    EXPECT_NEAR(last.points.col(1).maxCoeff(), 1 - 0.39 * 0.01, 1e-9) << kind;
    EXPECT_THAT(ran.listener.prints.back(), HasSubstr("smallest angle"));
    EXPECT_THAT(ran.listener.facts.at("settings"), HasSubstr(kind == "quadraticTriangle" ? "tri6" : "tri3"));
  }
}

TEST(SimulatePlane, NodesSelectTheEdgesBetweenThem) {
  const Language language;
  Scene scene = pulled_plate(language, "linearTriangle");
  scene.constraints.back() = condition(
      language, "surfacePressure",
      {{"indices", points_at(scene.mesh, 0, 2)}, {"pressure", std::vector<double>{-10}}, {"follower", false}});
  const Folder folder;
  const Ran ran = run(language, scene, folder);
  EXPECT_THAT(ran.listener.prints.back(), HasSubstr("sum of loads            (10, 0, 0)"));
}

TEST(SimulatePlane, PronySoftensASlowPull) {
  const Language language;
  Scene scene = pulled_plate(language, "linearTriangle");
  scene.regions[0].children.push_back(
      language.tag("prony", "prony", {{"g", std::vector<double>{0.3, 0.2}}, {"tau", std::vector<double>{1e-6, 1e-5}}}));
  const Folder folder;
  const Ran ran = run(language, scene, folder);
  const Mesh& last = *std::get<SeriesPtr>(ran.outputs.at(0))->last;
  // A pull over 5 time units is slow: the stiffness is the long-term half of the law's.
  EXPECT_NEAR(last.points(4, 0), 2 * (1 + 2 * 0.91 * 0.01), 1e-6);
  scene.regions[0].children.back() =
      language.tag("prony", "prony", {{"g", std::vector<double>{0.6, 0.5}}, {"tau", std::vector<double>{1, 2}}});
  EXPECT_THAT(fault(language, scene), HasSubstr("prony: the sum of g = 1.1 is not < 1"));
}

// -((1 + X) u')' = (1 + X)^-2 on (0, 1), u(0) = 1, 2 u'(1) = -1/2: u = 2 - 1/(1 + X) - ln(1 + X).
TEST(SimulateDiffusion, SolvesThePoissonProblemWithExpressions) {
  const Language language;
  Scene scene = cube(language);
  scene.mesh_kind = "quadraticLine";
  scene.mesh =
      std::make_shared<const Mesh>(operators::to_quadratic(operators::generate(operators::Segment{{}, 1, 32})));
  std::vector<int> lines(32);
  for (int k = 0; k < 32; ++k) lines[static_cast<std::size_t>(k)] = k;
  scene.regions = {
      language.tag("region", "region", {{"indices", index_set(scene.mesh, Indexed::elements, lines)}},
                   {language.tag("diffusionMaterial", "material", {{"coefficient", Formula(std::string("1 + X"))}})})};
  scene.constraints = {
      condition(language, "fixedValue", {{"indices", points_at(scene.mesh, 0, 0)}, {"value", Formula(1.0)}}),
      condition(language, "flux", {{"indices", points_at(scene.mesh, 0, 1)}, {"value", Formula(-0.5)}}),
      condition(language, "source", {{"value", Formula(std::string("(1 + X)^(-2)"))}})};
  scene.outputs = {language.tag("result", "output", {{"id", std::string("heat")}})};
  const Folder folder;
  const Ran ran = run(language, scene, folder);
  const Mesh& last = *std::get<SeriesPtr>(ran.outputs.at(0))->last;
  EXPECT_EQ(last.points, scene.mesh->points);  // nothing moves
  const Field& value = last.point_fields.front();
  ASSERT_EQ(value.name, "value");
  for (int n = 0; n < last.point_count(); ++n) {
    const double X = last.points(n, 0);
    EXPECT_NEAR(value.values[static_cast<std::size_t>(n)], 2 - 1 / (1 + X) - std::log(1 + X), 1e-6);  // h^3 / 32
  }
  scene = cube(language);
  scene.constraints = {
      condition(language, "fixedValue", {{"indices", points_at(scene.mesh, 0, 0)}, {"value", Formula(1.0)}})};
  EXPECT_THAT(fault(language, scene), HasSubstr("fixedValue: is for scalar problems"));
}

TEST(SimulatePlane, RefusesTheWrongKind) {
  const Language language;
  Scene scene = pulled_plate(language, "linearTriangle");
  scene.mesh_kind = "quadraticTriangle";
  EXPECT_THAT(fault(language, scene), HasSubstr("quadraticTriangle: the mesh has 16 tri3 cells, but tri6 are needed"));
  scene.mesh_kind = "linearTet";
  EXPECT_THAT(fault(language, scene), HasSubstr("linearTet: the mesh has no tetrahedra"));
}

}  // namespace
}  // namespace msml::test
