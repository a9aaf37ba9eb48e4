// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeIndicesFromMaterialId on a small mesh of two regions.
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

/// The cube of five tetrahedra, the inner one (cell 4) in region -7, and a triangle (cell 5) in it too.
Value two_regions() {
  Mesh mesh = five_tets();
  mesh.regions = {3, 3, 3, 3, -7};
  mesh.add_cell(CellKind::tri3, std::array<int, 3>{0, 1, 2}.data(), -7);
  return std::make_shared<const Mesh>(mesh);
}

std::vector<int> ids(const std::string& kind, Integer num, QuietReporter* listener = nullptr) {
  const Value mesh = two_regions();
  const auto set =
      output<IndexSet>(run("ComputeIndicesFromMaterialId", {{"mesh", mesh}, {"num", num}, {"type", kind}}, listener));
  EXPECT_EQ(set->mesh, output<Mesh>(mesh));
  return set->ids;
}

TEST(IndicesFromMaterial, IdsRunOverAllCells) {
  EXPECT_EQ(ids("elements", 3), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(ids("elements", -7), (std::vector<int>{4}));
  EXPECT_EQ(ids("faces", -7), (std::vector<int>{5}));
}

TEST(IndicesFromMaterial, PointsAreThoseOfAllCellsOfTheRegion) {
  EXPECT_EQ(ids("points", -7), (std::vector<int>{0, 1, 2, 4, 7}));
  EXPECT_EQ(ids("points_experimental", -7), ids("points", -7));
}

TEST(IndicesFromMaterial, AnUnknownRegionIsWarnedOfWithTheKnownOnes) {
  QuietReporter listener;
  EXPECT_TRUE(ids("elements", 8, &listener).empty());
  ASSERT_EQ(listener.warnings.size(), 1u);
  EXPECT_EQ(listener.warnings[0],
            "no elements have region 8; the mesh has 8 points, 5 tet4, 1 tri3 with regions -7, 3");
}

}  // namespace
}  // namespace msml::test
