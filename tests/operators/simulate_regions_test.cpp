// SPDX-License-Identifier: GPL-3.0-or-later
// Regions by elements and by nodes, and what happens to the elements in none or in two.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using testing::ElementsAre;
using testing::IsEmpty;

/// A bar of two cubes along z, 12 elements, with the regions given.
Scene bar(const Language& language, const std::vector<std::vector<int>>& regions, Indexed kind = Indexed::elements) {
  Scene scene = cube(language);
  scene.mesh = std::make_shared<const Mesh>(box(1, 1, 2));
  scene.regions.clear();
  const char* names[] = {"a", "b", "c"};
  for (std::size_t i = 0; i < regions.size(); ++i)
    scene.regions.push_back(region(language, names[i], index_set(scene.mesh, kind, regions[i])));
  return scene;
}

std::string message(const Language& language, const Scene& scene) {
  Listener listener;
  try {
    build_model(scene.record(language), listener, 1);
  } catch (const Error& error) {
    return error.str();
  }
  return "no error";
}

std::vector<int> range(int from, int to) {
  std::vector<int> ids;
  for (int i = from; i < to; ++i) ids.push_back(i);
  return ids;
}

TEST(Regions, ElementsAndDensityGoToTheModel) {
  const Language language;
  Listener listener;
  const auto simulation = build_model(bar(language, {range(0, 6), range(6, 12)}).record(language), listener, 1);
  ASSERT_EQ(simulation.model.regions.size(), 2U);
  EXPECT_EQ(simulation.model.regions[1].name, "b");
  EXPECT_EQ(simulation.model.regions[1].elements, range(6, 12));
  EXPECT_EQ(simulation.model.regions[1].density, 2.0);
  EXPECT_THAT(listener.warnings, IsEmpty());
}

TEST(Regions, AnElementBelongsToANodeRegionWhenAllItsCornersDo) {
  const Language language;
  Listener listener;
  // Points 0 to 7 are the corners of the lower cube, 4 to 11 of the upper one.
  const auto simulation =
      build_model(bar(language, {range(0, 8), range(4, 12)}, Indexed::nodes).record(language), listener, 1);
  EXPECT_EQ(simulation.model.regions[0].elements, range(0, 6));
  EXPECT_EQ(simulation.model.regions[1].elements, range(6, 12));
}

TEST(Regions, ASingleRegionExtendsToTheRestWithACount) {
  const Language language;
  Listener listener;
  const auto simulation = build_model(bar(language, {range(0, 9)}).record(language), listener, 1);
  EXPECT_EQ(simulation.model.regions[0].elements.size(), 12U);
  EXPECT_THAT(listener.warnings, ElementsAre("line 7: region: the indices of region 'a' leave out 3 of 12 elements; as "
                                             "the only region it is extended to them. Widen its indices"));
}

TEST(Regions, ElementsInNoneOfSeveralRegionsAreCountedAndLocated) {
  const Language language;
  EXPECT_EQ(message(language, bar(language, {range(0, 6), range(6, 11)})),
            "scene.xml:7: 1 of 12 elements belong to no region; their centres lie in (0.5, 0.75, 1.25) to (0.5, 0.75, "
            "1.25), the first is element 11 at (0.5, 0.75, 1.25). Widen the indices of a region");
}

TEST(Regions, OfTwoRegionsThatClaimAnElementTheLaterWins) {
  const Language language;
  Listener listener;
  const auto simulation = build_model(bar(language, {range(0, 8), range(6, 12)}).record(language), listener, 1);
  EXPECT_EQ(simulation.model.regions[0].elements, range(0, 6));
  EXPECT_EQ(simulation.model.regions[1].elements, range(6, 12));
  EXPECT_THAT(listener.warnings, ElementsAre("line 7: region: regions 'a' and 'b' both claim 2 elements; the later, "
                                             "'b', has them. Leave them out of the indices of one"));
}

TEST(Regions, ARegionWithoutElementsIsWarnedOfAndLeftOut) {
  const Language language;
  Listener listener;
  const auto simulation = build_model(bar(language, {range(0, 12), {}}).record(language), listener, 1);
  EXPECT_EQ(simulation.model.regions.size(), 1U);
  EXPECT_THAT(listener.warnings, ElementsAre("line 7: region: region 'b' has no elements. Check its indices, or "
                                             "leave it out"));
}

TEST(Regions, FacesAreRefused) {
  const Language language;
  EXPECT_EQ(message(language, bar(language, {{0}}, Indexed::faces)),
            "scene.xml:7: region: indices counts faces; a region needs elements, or nodes whose elements are meant");
}

TEST(Regions, LiteralIdsOutsideTheMeshAreNamedWithTheRange) {
  const Language language;
  Scene scene = bar(language, {{0, 12}});
  scene.regions = {region(language, "a", index_set(nullptr, Indexed::elements, {0, 12}))};
  EXPECT_EQ(message(language, scene), "scene.xml:7: region: indices names element 12, but the mesh has cells 0 to 11");
  scene.regions = {region(language, "a", index_set(nullptr, Indexed::nodes, {-1}))};
  EXPECT_EQ(message(language, scene), "scene.xml:7: region: indices names node -1, but the mesh has nodes 0 to 11");
}

TEST(Regions, IndicesOfAnotherMeshAreRefused) {
  const Language language;
  Scene scene = bar(language, {range(0, 12)});
  const auto other = std::make_shared<const Mesh>(box(1, 1, 1));
  scene.regions = {region(language, "a", index_set(other, Indexed::elements, {0}))};
  EXPECT_EQ(
      message(language, scene),
      "scene.xml:7: region: indices counts elements of another mesh (8 points, 6 tet4) than the object's (12 points, "
      "12 tet4); take them from the mesh that the object uses");
}

TEST(Regions, IndicesOfAnEqualMeshReadTwiceAreAccepted) {
  const Language language;
  Listener listener;
  Scene scene = bar(language, {range(0, 12)});
  const auto same = std::make_shared<const Mesh>(*scene.mesh);
  scene.regions = {region(language, "a", index_set(same, Indexed::elements, range(0, 12)))};
  EXPECT_NO_THROW(build_model(scene.record(language), listener, 1));
}

TEST(MeshKind, ATet4MeshIsNoQuadraticTet) {
  const Language language;
  Scene scene = bar(language, {range(0, 12)});
  scene.mesh_kind = "quadraticTet";
  EXPECT_EQ(message(language, scene),
            "scene.xml:7: quadraticTet: the mesh has 12 tet4 cells, but tet10 are needed; convert it with "
            "ConvertLinearToQuadraticTetrahedralMesh");
}

TEST(MeshKind, ATet10MeshIsNoLinearTet) {
  const Language language;
  Scene scene = cube(language);
  auto mesh = std::make_shared<Mesh>();
  mesh->points = Points::Zero(10, 3);
  const int nodes[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  mesh->add_cell(CellKind::tet10, nodes);
  scene.mesh = mesh;
  EXPECT_EQ(
      message(language, scene),
      "scene.xml:7: linearTet: the mesh has 1 tet10 cells, but tet4 are needed; use quadraticTet, or the mesh before "
      "ConvertLinearToQuadraticTetrahedralMesh");
}

TEST(MeshKind, AMeshOfTrianglesHasNoTetrahedra) {
  const Language language;
  Scene scene = cube(language);
  auto mesh = std::make_shared<Mesh>();
  mesh->points = Points::Zero(3, 3);
  const int nodes[3] = {0, 1, 2};
  mesh->add_cell(CellKind::tri3, nodes);
  scene.mesh = mesh;
  EXPECT_EQ(message(language, scene),
            "scene.xml:7: linearTet: the mesh has no tetrahedra (3 points, 1 tri3); fill a surface with "
            "CGALMeshVolumeFromSurface first");
}

}  // namespace
}  // namespace msml::test
