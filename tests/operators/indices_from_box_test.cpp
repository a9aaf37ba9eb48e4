// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeIndicesFromBoxROI on lattices where the answer can be counted.
#include <filesystem>

#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

using Numbers = std::vector<double>;

Value unit_cube(bool quadratic = false) {
  return run("GenerateBoxMesh",
             {{"size", Numbers{1, 1, 1}}, {"divisions", std::vector<Integer>{2, 2, 2}}, {"quadratic", quadratic}});
}

std::shared_ptr<const IndexSet> select(const Value& mesh, const std::string& what, const Numbers& box,
                                       QuietReporter* listener = nullptr) {
  return output<IndexSet>(run("ComputeIndicesFromBoxROI", {{"mesh", mesh}, {"select", what}, {"box", box}}, listener));
}

TEST(IndicesFromBox, FacesOfTheBoxBelongToIt) {
  const Value mesh = unit_cube();
  const auto set = select(mesh, "points", {0, 0, 0, 1, 1, 0});
  EXPECT_EQ(set->ids.size(), 9u);
  EXPECT_EQ(set->kind, Indexed::nodes);
  EXPECT_EQ(set->mesh, output<Mesh>(mesh));
}

TEST(IndicesFromBox, ElementsLieInsideCompletely) {
  const auto set = select(unit_cube(), "elements", {0, 0, 0, 1, 1, 0.5});
  EXPECT_EQ(set->ids.size(), 24u);  // four of eight cells
  EXPECT_EQ(set->kind, Indexed::elements);
  EXPECT_EQ(select(unit_cube(), "elements", {0, 0, 0, 1, 1, 0.99})->ids.size(), 24u);
  EXPECT_EQ(select(unit_cube(true), "elements", {0, 0, 0, 1, 1, 0.5})->ids.size(), 24u);
}

TEST(IndicesFromBox, SurfaceElementsAreCellIdsOfTheMixedGrid) {
  Mesh mesh = *output<Mesh>(unit_cube());
  const int last = mesh.cell_count();
  mesh.add_cell(CellKind::tri3, std::array<int, 3>{0, 1, 2}.data());
  mesh.add_cell(CellKind::tri3, std::array<int, 3>{0, 1, 26}.data());
  const Vec3 low = mesh.points.topRows<3>().colwise().minCoeff(), high = mesh.points.topRows<3>().colwise().maxCoeff();
  const auto set = select(std::make_shared<const Mesh>(mesh), "surfaceElements",
                          {low[0], low[1], low[2], high[0], high[1], high[2]});
  EXPECT_EQ(set->kind, Indexed::faces);
  ASSERT_FALSE(set->ids.empty());
  EXPECT_EQ(set->ids.front(), last);
}

TEST(IndicesFromBox, AnEmptyBoxIsWarnedOfWithTheBoundsOfTheMesh) {
  QuietReporter listener;
  EXPECT_TRUE(select(unit_cube(), "points", {2, 2, 2, 3, 3, 3}, &listener)->ids.empty());
  ASSERT_EQ(listener.warnings.size(), 1u);
  EXPECT_EQ(listener.warnings[0], "no points lie in the box; the mesh reaches from (0 0 0) to (1 1 1)");
}

TEST(IndicesFromBox, RefusesAnInvertedBoxAndMissingTriangles) {
  const Value mesh = unit_cube();
  EXPECT_EQ(error_of("ComputeIndicesFromBoxROI",
                     {{"mesh", mesh}, {"select", std::string("points")}, {"box", Numbers{0, 2, 0, 1, 1, 1}}}),
            "box: ymin = 2 is above ymax = 1; the order is xmin ymin zmin xmax ymax zmax");
  EXPECT_EQ(error_of("ComputeIndicesFromBoxROI",
                     {{"mesh", mesh}, {"select", std::string("surfaceElements")}, {"box", Numbers{0, 0, 0, 1, 1, 1}}}),
            "select = surfaceElements needs triangles, but the mesh has 27 points, 48 tet4; make them with "
            "ExtractSurfaceMesh, or select points");
}

TEST(IndicesFromBox, FindsTheFixedEndOfTheBeam) {
  const std::filesystem::path file = MSML_SOURCE_DIR "/../shared/scenes/beam/Beam_Tet4_NElement=1810.vtk";
  Registry registry;
  add_operators(registry);
  if (!std::filesystem::exists(file) || registry.format(file) == nullptr) GTEST_SKIP() << "no beam to read: " << file;
  const Value mesh = registry.read(file, Type::mesh);
  EXPECT_EQ(select(mesh, "elements", {-0.1, -0.1, -0.1, 0.04, 0.07, 0.21})->ids.size(), 1810u);
  long at_zero = 0;
  for (int i = 0; i < output<Mesh>(mesh)->point_count(); ++i)
    at_zero += std::abs(output<Mesh>(mesh)->points(i, 2)) <= 1e-8;
  EXPECT_EQ(select(mesh, "points", {0, 0, -1e-8, 0.03, 0.06, 1e-8})->ids.size(), static_cast<std::size_t>(at_zero));
  EXPECT_GT(at_zero, 0);
}

}  // namespace
}  // namespace msml::test
