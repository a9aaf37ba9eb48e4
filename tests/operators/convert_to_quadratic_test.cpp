// SPDX-License-Identifier: GPL-3.0-or-later
// ConvertLinearToQuadraticTetrahedralMesh: numbering, data, and curved boundaries.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

constexpr double pi = std::numbers::pi;
const std::string tag = "ConvertLinearToQuadraticTetrahedralMesh";

Value stored(Mesh mesh) { return std::make_shared<const Mesh>(std::move(mesh)); }

TEST(ConvertToQuadratic, PutsMidNodesWhereVtkHasThem) {
  const auto mesh = output<Mesh>(run(tag, {{"mesh", stored(five_tets())}}));
  constexpr int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  ASSERT_EQ(mesh->count(CellKind::tet10), 5);
  for (int c = 0; c < 5; ++c)
    for (int e = 0; e < 6; ++e) {
      const int* nodes = mesh->cell(c);
      const Vec3 middle = (mesh->points.row(nodes[ends[e][0]]) + mesh->points.row(nodes[ends[e][1]])) / 2;
      EXPECT_EQ(Vec3(mesh->points.row(nodes[4 + e])), middle);
    }
  EXPECT_EQ(mesh->point_count(), 8 + 18);  // 12 edges of the cube and a diagonal on each of 6 sides
  EXPECT_NO_THROW(mesh->check());
}

TEST(ConvertToQuadratic, KeepsRegionsAndFieldsAndInterpolatesAtMidNodes) {
  Mesh linear = five_tets();
  linear.regions = {5, 4, 3, 2, 1};
  linear.cell_fields.push_back({"id", 1, {0, 1, 2, 3, 4}});
  Field field{"xy", 2, {}};
  for (int i = 0; i < 8; ++i) field.values.insert(field.values.end(), {linear.points(i, 0), 2 * linear.points(i, 1)});
  linear.point_fields.push_back(field);
  linear.add_cell(CellKind::tri3, std::array<int, 3>{0, 1, 2}.data(), 9);
  linear.cell_fields[0].values.push_back(5);
  const auto mesh = output<Mesh>(run(tag, {{"mesh", stored(linear)}}));
  EXPECT_EQ(mesh->regions, linear.regions);
  EXPECT_EQ(mesh->cell_fields[0].values, linear.cell_fields[0].values);
  EXPECT_EQ(mesh->kinds.back(), CellKind::tri6);
  for (int i = 0; i < mesh->point_count(); ++i) {
    EXPECT_EQ(mesh->point_fields[0].values[2 * static_cast<std::size_t>(i)], mesh->points(i, 0));
    EXPECT_EQ(mesh->point_fields[0].values[2 * static_cast<std::size_t>(i) + 1], 2 * mesh->points(i, 1));
  }
}

Value ball(Integer around) {
  return run("GenerateSphereMesh", {{"radius", 1.0}, {"around", around}, {"across", around}});
}

/// A surface so fine that its own distance from the sphere (1e-4 of the radius) is far below what is measured.
Value fine_sphere() { return run("ExtractSurfaceMesh", {{"mesh", ball(32)}}); }

double curved_volume(const Value& mesh) {
  const auto measured = output<Mesh>(run("MeasureMeshQuality", {{"mesh", mesh}}));
  double sum = 0;
  for (const double v : measured->cell_fields.front().values) sum += v;
  return sum;
}

TEST(ConvertToQuadratic, ProjectedBoundariesLowerTheVolumeErrorOfABallByAnOrder) {
  const double exact = 4 * pi / 3;
  const Value straight = run(tag, {{"mesh", ball(3)}});
  QuietReporter listener;
  const Value curved = run(tag, {{"mesh", ball(3)}, {"projectOnto", fine_sphere()}}, &listener);
  EXPECT_NEAR(curved_volume(straight), total_volume(*output<Mesh>(straight)), 1e-12);  // straight edges: the same body
  EXPECT_LT(std::abs(curved_volume(curved) - exact), 0.1 * std::abs(curved_volume(straight) - exact));
  EXPECT_TRUE(listener.warnings.empty());
  // 6 sides of 6 x 6 squares: Euler gives 3 edges for every 2 of the 432 triangles.
  EXPECT_THAT(listener.notes,
              ::testing::ElementsAre(::testing::StartsWith("648 mid nodes of the boundary placed on the surface")));
}

TEST(ConvertToQuadratic, ElementsThatWouldInvertKeepStraightEdges) {
  // The surface lies far across the tetrahedron: nearest points would turn it inside out.
  Mesh one;
  one.points.resize(4, 3);
  one.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  one.add_cell(CellKind::tet4, std::array<int, 4>{0, 1, 2, 3}.data());
  const Value surface = std::make_shared<const Surface>(box(Vec3(5, 5, 5), Vec3(6, 6, 6)));
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(tag, {{"mesh", stored(one)}, {"projectOnto", surface}}, &listener));
  EXPECT_NEAR(curved_volume(std::make_shared<const Mesh>(*mesh)), 1.0 / 6, 1e-15);
  ASSERT_EQ(listener.warnings.size(), 1u);
  EXPECT_EQ(listener.warnings[0],
            "6 of 6 mid nodes of the boundary stay on straight edges: bent ones would invert an element");
}

TEST(ConvertToQuadratic, TakesTrianglesAloneButProjectsTetrahedraOnly) {
  const Surface cube = box(Vec3::Zero(), Vec3::Ones());
  const Mesh triangles = to_mesh(cube);
  const auto quadratic = output<Mesh>(run(tag, {{"mesh", stored(triangles)}}));
  EXPECT_EQ(quadratic->count(CellKind::tri6), 12);
  EXPECT_EQ(quadratic->point_count(), 8 + 18);  // corners and edges
  EXPECT_EQ(error_of(tag, {{"mesh", stored(triangles)}, {"projectOnto", std::make_shared<const Surface>(cube)}}),
            "ConvertLinearToQuadraticTetrahedralMesh needs tetrahedra, but the mesh has 8 points, 12 tri3");
}

}  // namespace
}  // namespace msml::test
