// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints and loads: what index sets mean, which steps they act in, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using testing::ElementsAre;
using testing::IsEmpty;

using Numbers = std::vector<double>;

struct Built {
  Listener listener;
  simulation::Simulation simulation;
  std::string error;
  const fe::Step& step(std::size_t i = 0) const { return simulation.model.steps.at(i); }
};

Built build(const Language& language, const Scene& scene) {
  Built built;
  try {
    built.simulation = build_model(scene.record(language), built.listener, 1);
  } catch (const Error& error) {
    built.error = error.str();
  }
  return built;
}

/// The cube with one condition.
Built build(const Language& language, const std::string& tag, const Attributes& attributes,
            const std::string& for_step = "") {
  Scene scene = cube(language);
  scene.constraints = {condition(language, tag, attributes, for_step)};
  return build(language, scene);
}

IndexSetPtr nodes(std::vector<int> ids) { return index_set(nullptr, Indexed::nodes, std::move(ids)); }

/// One cube of six tetrahedra whose top holds two triangles: of its own points, or of duplicates.
MeshPtr cube_with_top(bool duplicates, bool float_precision = false) {
  auto mesh = std::make_shared<Mesh>(box(1, 1, 1, 0.1));
  std::vector<int> top{4, 5, 6, 7};
  if (duplicates) {
    mesh->points.conservativeResize(12, 3);
    for (int i = 0; i < 4; ++i) {
      mesh->points.row(8 + i) = mesh->points.row(4 + i);
      if (float_precision) mesh->points.row(8 + i) = mesh->points.row(4 + i).cast<float>().cast<double>();
      top[static_cast<std::size_t>(i)] = 8 + i;
    }
  }
  // The diagonal of the top runs from its corner (0 0) to (1 1), as the tetrahedra have it.
  const int first[3] = {top[0], top[1], top[3]}, second[3] = {top[3], top[2], top[0]};
  mesh->add_cell(CellKind::tri3, first);
  mesh->add_cell(CellKind::tri3, second);
  return mesh;
}

Scene topped(const Language& language, const MeshPtr& mesh, const Attributes& load,
             const std::string& tag = "surfacePressure", const std::string& strain = "corotated") {
  Scene scene = cube(language);
  scene.mesh = mesh;
  scene.regions = {region(language, "a", index_set(mesh, Indexed::elements, {0, 1, 2, 3, 4, 5}), 1000, 0.3, strain)};
  scene.constraints = {condition(language, tag, load)};
  return scene;
}

TEST(FixedConstraint, HoldsItsNodesAtOnce) {
  const Language language;
  const auto built = build(language, "fixedConstraint", {{"indices", nodes({3, 5})}});
  const auto& prescribed = built.step().prescribed.at(0);
  EXPECT_THAT(prescribed.nodes, ElementsAre(3, 5));
  EXPECT_THAT(prescribed.values, ElementsAre(Vec3(0, 0, 0)));
  EXPECT_EQ(prescribed.ramp, fe::Ramp::step);
  EXPECT_THAT(prescribed.components, ElementsAre(true, true, true));
}

TEST(FixedConstraint, HoldsTheComponentsItNames) {
  const Language language;
  const auto built = build(language, "fixedConstraint", {{"indices", nodes({3})}, {"components", std::string("z, x")}});
  EXPECT_THAT(built.step().prescribed.at(0).components, ElementsAre(true, false, true));
}

TEST(Indices, AnEmptySetIsRefusedWithTheBounds) {
  const Language language;
  for (const char* tag : {"fixedConstraint", "surfacePressure"}) {
    Attributes attributes{{"indices", nodes({})}};
    if (std::string(tag) == "surfacePressure") attributes["pressure"] = Numbers{1};
    EXPECT_EQ(build(language, tag, attributes).error,
              std::string("scene.xml:7: ") + tag + ": indices is empty; the body spans (0, 0, 0) to (1, 1, 1)");
  }
}

TEST(Indices, ANodeListedTwiceIsRefused) {
  const Language language;
  EXPECT_EQ(build(language, "fixedConstraint", {{"indices", nodes({3, 5, 3})}}).error,
            "scene.xml:7: fixedConstraint: indices lists node 3 twice");
}

TEST(Indices, LiteralIdsOutsideTheMeshAreRefused) {
  const Language language;
  EXPECT_EQ(build(language, "fixedConstraint", {{"indices", nodes({26, 27})}}).error,
            "scene.xml:7: fixedConstraint: indices names node 27, but the mesh has nodes 0 to 26");
}

TEST(Indices, ElementsStandForTheirNodes) {
  const Language language;
  const auto built = build(language, "fixedConstraint", {{"indices", index_set(nullptr, Indexed::elements, {0})}});
  EXPECT_THAT(built.step().prescribed.at(0).nodes,
              ElementsAre(0, 1, 4, 13));  // the path x, y, z through the first cube
}

TEST(Indices, PointsOfNoElementAreLeftOutWithANote) {
  const Language language;
  const auto mesh = cube_with_top(true);
  Scene scene = topped(language, mesh, {{"indices", nodes({4, 8, 9})}}, "fixedConstraint");
  const auto built = build(language, scene);
  EXPECT_THAT(built.step().prescribed.at(0).nodes, ElementsAre(4));
  EXPECT_THAT(built.listener.notes,
              ElementsAre("fixedConstraint: 2 of the 3 nodes in indices belong to no element and carry no unknowns"));
  scene = topped(language, mesh, {{"indices", nodes({8, 9})}}, "fixedConstraint");
  EXPECT_EQ(
      build(language, scene).error,
      "scene.xml:7: fixedConstraint: none of the 2 nodes in indices belongs to an element of the body, which spans "
      "(0, 0, 0) to (0.1, 0.1, 0.1)");
}

TEST(DisplacementConstraint, TakesThreeNumbersForAllOrThreeForEachNode) {
  const Language language;
  const auto one =
      build(language, "displacementConstraint", {{"indices", nodes({3, 5})}, {"displacement", Numbers{1, 2, 3}}});
  EXPECT_THAT(one.step().prescribed.at(0).values, ElementsAre(Vec3(1, 2, 3)));
  EXPECT_EQ(one.step().prescribed.at(0).ramp, fe::Ramp::linear);
  const auto each = build(language, "displacementConstraint",
                          {{"indices", nodes({3, 5})}, {"displacement", Numbers{1, 2, 3, 4, 5, 6}}});
  EXPECT_THAT(each.step().prescribed.at(0).values, ElementsAre(Vec3(1, 2, 3), Vec3(4, 5, 6)));
}

TEST(DisplacementConstraint, RefusesOtherCounts) {
  const Language language;
  EXPECT_EQ(
      build(language, "displacementConstraint", {{"indices", nodes({3, 5, 6})}, {"displacement", Numbers(6)}}).error,
      "scene.xml:7: displacementConstraint: displacement has 6 numbers; allowed are 3, or 3 for each of the 3 nodes "
      "in indices (9)");
}

TEST(DisplacementConstraint, KeepsValuesWithTheirNodesWherePointsAreLeftOut) {
  const Language language;
  const Scene scene =
      topped(language, cube_with_top(true), {{"indices", nodes({8, 4})}, {"displacement", Numbers{1, 2, 3, 4, 5, 6}}},
             "displacementConstraint");
  const auto built = build(language, scene);
  EXPECT_THAT(built.step().prescribed.at(0).values, ElementsAre(Vec3(4, 5, 6)));
}

TEST(ForceConstraint, ActsOnEveryNodeAndWarnsOfPointsWithoutElements) {
  const Language language;
  const Scene scene = topped(language, cube_with_top(true), {{"indices", nodes({4, 8})}, {"force", Numbers{1, 0, 0}}},
                             "forceConstraint");
  const auto built = build(language, scene);
  EXPECT_THAT(built.step().forces.at(0).nodes, ElementsAre(4));
  EXPECT_THAT(built.listener.warnings,
              ElementsAre("line 7: forceConstraint: no force acts on 1 of the 2 nodes in indices, which belong to no "
                          "element; name nodes of the body"));
}

TEST(SurfacePressure, NodesMeanTheBoundaryFacesWithAllCornersAmongThem) {
  const Language language;
  const Scene scene = cube(language);
  const auto built =
      build(language, "surfacePressure", {{"indices", points_at(scene.mesh, 2, 1)}, {"pressure", Numbers{-5}}});
  const auto& load = built.step().face_loads.at(0);
  EXPECT_EQ(load.faces.size(), 8U);  // four squares of two triangles
  for (const auto& face : load.faces)
    for (const int node : simulation::face_nodes(*scene.mesh, face)) EXPECT_EQ(scene.mesh->points(node, 2), 1);
  EXPECT_THAT(load.pressures, ElementsAre(-5));
  EXPECT_TRUE(load.follower);
}

TEST(SurfacePressure, NodesWithoutAFaceAreRefused) {
  const Language language;
  EXPECT_EQ(
      build(language, "surfacePressure", {{"indices", nodes({0, 26})}, {"pressure", Numbers{1}}}).error,
      "scene.xml:7: surfacePressure: no boundary face has all its corners among the 2 nodes in indices; the body spans "
      "(0, 0, 0) to (1, 1, 1)");
}

TEST(SurfacePressure, TrianglesAreMatchedByNodesOrByPlace) {
  const Language language;
  for (const bool duplicates : {false, true}) {
    const auto mesh = cube_with_top(duplicates, true);
    const auto built = build(
        language,
        topped(language, mesh, {{"indices", index_set(mesh, Indexed::faces, {6, 7})}, {"pressure", Numbers{1, 2}}}));
    ASSERT_EQ(built.error, "");
    const auto& load = built.step().face_loads.at(0);
    ASSERT_EQ(load.faces.size(), 2U);
    EXPECT_THAT(load.pressures, ElementsAre(1, 2));
    EXPECT_THAT(simulation::face_nodes(*mesh, load.faces[0]), testing::UnorderedElementsAre(4, 5, 7));
    EXPECT_THAT(simulation::face_nodes(*mesh, load.faces[1]), testing::UnorderedElementsAre(4, 6, 7));
  }
}

TEST(SurfacePressure, TrianglesWithoutAFaceAreCounted) {
  const Language language;
  auto mesh = std::make_shared<Mesh>(*cube_with_top(true));
  mesh->points.row(9) += Eigen::RowVector3d(0, 0, 0.001);
  EXPECT_EQ(
      build(language,
            topped(language, mesh, {{"indices", index_set(mesh, Indexed::faces, {6, 7})}, {"pressure", Numbers{1}}}))
          .error,
      "scene.xml:7: surfacePressure: 1 of the 2 faces in indices match no face of an element; the first is cell 6 at "
      "(0.06667, 0.03333, 0.1003)");
}

TEST(SurfacePressure, TrianglesInsideTheBodyAreCounted) {
  const Language language;
  auto mesh = std::make_shared<Mesh>(box(1, 1, 1));
  const int inner[3] = {0, 1, 7};  // a face between two of the six tetrahedra around the diagonal
  mesh->add_cell(CellKind::tri3, inner);
  EXPECT_EQ(
      build(language,
            topped(language, mesh, {{"indices", index_set(mesh, Indexed::faces, {6})}, {"pressure", Numbers{1}}}))
          .error,
      "scene.xml:7: surfacePressure: 1 of the 1 face in indices lie between two elements, not on the boundary; the "
      "first is cell 6 at (0.6667, 0.3333, 0.3333)");
}

TEST(SurfacePressure, OneFaceNamedByTwoTrianglesIsRefused) {
  const Language language;
  auto mesh = std::make_shared<Mesh>(*cube_with_top(false));
  const int again[3] = {5, 7, 4};
  mesh->add_cell(CellKind::tri3, again);
  EXPECT_EQ(build(language, topped(language, mesh,
                                   {{"indices", index_set(mesh, Indexed::faces, {6, 8})}, {"pressure", Numbers{1}}}))
                .error,
            "scene.xml:7: surfacePressure: cells 6 and 8 in indices are the same face of the body, at (0.06667, "
            "0.03333, 0.1)");
}

TEST(SurfacePressure, TetrahedraAreNoFaces) {
  const Language language;
  EXPECT_EQ(
      build(language, "surfacePressure",
            {{"indices", index_set(nullptr, Indexed::elements, {0})}, {"pressure", Numbers{1}}})
          .error,
      "scene.xml:7: surfacePressure: indices names cell 0, which is a tet4; triangle cells are wanted, for example "
      "from ComputeIndicesFromBoxROI with select=\"surfaceElements\"");
}

TEST(SurfacePressure, ThreeNumbersAreATractionVector) {
  const Language language;
  const auto built = build(language, "surfacePressure",
                           {{"indices", points_at(cube(language).mesh, 0, 1)}, {"pressure", Numbers{0.5, 0, -1}}});
  EXPECT_THAT(built.step().face_loads.at(0).tractions, ElementsAre(Vec3(0.5, 0, -1)));
  EXPECT_FALSE(built.step().face_loads.at(0).follower);
}

TEST(SurfacePressure, RefusesOtherCounts) {
  const Language language;
  const auto mesh = cube_with_top(false);
  EXPECT_EQ(
      build(language,
            topped(language, mesh, {{"indices", index_set(mesh, Indexed::faces, {6, 7})}, {"pressure", Numbers(4)}}))
          .error,
      "scene.xml:7: surfacePressure: pressure has 4 numbers; allowed are 1, 3 (a traction vector), or one for each of "
      "the 2 faces in indices");
  EXPECT_EQ(
      build(language, "surfacePressure", {{"indices", points_at(cube(language).mesh, 0, 1)}, {"pressure", Numbers(8)}})
          .error,
      "scene.xml:7: surfacePressure: pressure has 8 numbers; allowed are 1, 3 (a traction vector) where indices counts "
      "nodes");
}

TEST(SurfacePressure, DoesNotFollowWhereStrainIsSmall) {
  const Language language;
  const auto mesh = cube_with_top(false);
  Attributes load{{"indices", index_set(mesh, Indexed::faces, {6})}, {"pressure", Numbers{1}}};
  EXPECT_FALSE(build(language, topped(language, mesh, load, "surfacePressure", "small")).step().face_loads[0].follower);
  load["follower"] = true;
  EXPECT_TRUE(build(language, topped(language, mesh, load, "surfacePressure", "small")).step().face_loads[0].follower);
  load["pressure"] = Numbers{1, 2, 3};
  EXPECT_EQ(
      build(language, topped(language, mesh, load)).error,
      "scene.xml:7: surfacePressure: follower = true has no meaning for a traction vector (three numbers), which keeps "
      "its direction");
}

TEST(SurfacePressureOnMesh, MatchesTheTrianglesOfASeparateSurface) {
  const Language language;
  const auto mesh = cube_with_top(false);
  auto surface = std::make_shared<Mesh>();
  surface->points = mesh->points.bottomRows(4);
  const int top[3] = {0, 1, 3}, second[3] = {3, 2, 0};
  surface->add_cell(CellKind::tri3, top);
  surface->add_cell(CellKind::tri3, second);
  Attributes load{
      {"mesh", MeshPtr(surface)}, {"indices", index_set(surface, Indexed::faces, {1})}, {"pressure", Numbers{3}}};
  const auto built = build(language, topped(language, mesh, load, "surfacePressureOnMesh"));
  ASSERT_EQ(built.error, "");
  ASSERT_EQ(built.step().face_loads.at(0).faces.size(), 1U);
  EXPECT_THAT(simulation::face_nodes(*mesh, built.step().face_loads[0].faces[0]),
              testing::UnorderedElementsAre(4, 6, 7));
}

Scene two_steps(const Language& language) {
  Scene scene = cube(language);
  scene.steps = {language.tag("step", "step", {{"name", std::string("one")}}),
                 language.tag("step", "step", {{"name", std::string("two")}})};
  return scene;
}

TEST(ForStep, AConditionActsInItsStepOrInAll) {
  const Language language;
  Scene scene = two_steps(language);
  scene.constraints = {
      condition(language, "fixedConstraint", {{"indices", nodes({0})}}),
      condition(language, "fixedConstraint", {{"indices", nodes({1})}}, "two"),
      condition(language, "fixedConstraint", {{"indices", nodes({2})}, {"forStep", std::string("one")}})};
  const auto built = build(language, scene);
  ASSERT_EQ(built.step(0).prescribed.size(), 2U);
  EXPECT_THAT(built.step(0).prescribed[1].nodes, ElementsAre(2));
  ASSERT_EQ(built.step(1).prescribed.size(), 2U);
  EXPECT_THAT(built.step(1).prescribed[1].nodes, ElementsAre(1));
}

TEST(ForStep, ANameThatIsNoStepNeverActs) {
  const Language language;
  Scene scene = two_steps(language);
  scene.constraints = {condition(language, "fixedConstraint", {{"indices", nodes({0})}}, "tvo")};
  const auto built = build(language, scene);
  EXPECT_THAT(built.step(0).prescribed, IsEmpty());
  EXPECT_THAT(built.listener.notes,
              ::testing::Contains("line 7: fixedConstraint never acts: forStep = 'tvo' is no step "
                                  "(did you mean 'two'?); the steps are one, two"));
}

TEST(ForStep, ADisplacementHoldsInLaterStepsWhereTheySayNothingOfItsNodes) {
  const Language language;
  Scene scene = two_steps(language);
  scene.constraints = {
      condition(language, "displacementConstraint",
                {{"indices", nodes({0, 1, 2})}, {"displacement", Numbers{1, 0, 0, 2, 0, 0, 3, 0, 0}}}, "one"),
      condition(language, "forceConstraint", {{"indices", nodes({1})}, {"force", Numbers{1, 0, 0}}}, "two")};
  const auto built = build(language, scene);
  ASSERT_EQ(built.step(1).prescribed.size(), 1U);
  EXPECT_THAT(built.step(1).prescribed[0].nodes, ElementsAre(0, 2));
  EXPECT_THAT(built.step(1).prescribed[0].values, ElementsAre(Vec3(1, 0, 0), Vec3(3, 0, 0)));
  EXPECT_EQ(built.step(1).prescribed[0].ramp, fe::Ramp::step);
}

TEST(Conflicts, EqualValuesAreAllowedAndOthersWarnedOf) {
  const Language language;
  Scene scene = cube(language);
  const auto fix = condition(language, "fixedConstraint", {{"indices", nodes({0, 1})}});
  scene.constraints = {fix, condition(language, "displacementConstraint",
                                      {{"indices", nodes({1, 2})}, {"displacement", Numbers{0, 0, 0}}})};
  EXPECT_THAT(build(language, scene).listener.warnings, IsEmpty());
  scene.constraints = {fix, condition(language, "displacementConstraint",
                                      {{"indices", nodes({1, 2})}, {"displacement", Numbers{0, 0, 1}}})};
  EXPECT_THAT(
      build(language, scene).listener.warnings,
      ElementsAre("step 'initial': 'fixedConstraint' and 'displacementConstraint' hold 1 node differently (the first "
                  "is node 1); the later, 'displacementConstraint', wins. Take the nodes out of the indices of one"));
}

}  // namespace
}  // namespace msml::test
