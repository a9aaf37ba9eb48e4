// SPDX-License-Identifier: GPL-3.0-or-later
// MeasureMeshQuality against values of tetrahedra that geometry knows.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

using ::testing::HasSubstr;

Value tet(const std::vector<Vec3>& corners) {
  Mesh mesh;
  mesh.points.resize(static_cast<int>(corners.size()), 3);
  for (int i = 0; i < static_cast<int>(corners.size()); ++i) mesh.points.row(i) = corners[static_cast<std::size_t>(i)];
  std::vector<int> ids;
  for (int i = 0; i < static_cast<int>(corners.size()); ++i) ids.push_back(i);
  mesh.add_cell(corners.size() == 4 ? CellKind::tet4 : CellKind::tet10, ids.data());
  return std::make_shared<const Mesh>(mesh);
}

/// The measures of one tetrahedron by name.
std::map<std::string, double> measured(const Value& mesh) {
  std::map<std::string, double> found;
  const auto mesh_with_fields = output<Mesh>(run("MeasureMeshQuality", {{"mesh", mesh}}));
  for (const Field& field : mesh_with_fields->cell_fields) found[field.name] = field.values[0];
  return found;
}

const std::vector<Vec3> regular{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};  // edges sqrt(8), right-handed
const std::vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};         // of a cube

TEST(MeasureQuality, KnowsTheRegularTetrahedron) {
  auto q = measured(tet(regular));
  const double tolerance = 1e-12;  // round-off of a few square roots
  EXPECT_NEAR(q["volume"], 8.0 / 3, tolerance);
  EXPECT_NEAR(q["edgeRatio"], 1, tolerance);
  EXPECT_NEAR(q["minDihedralAngle"], std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-10);
  EXPECT_NEAR(q["maxDihedralAngle"], 70.528779365509308, 1e-10);
  EXPECT_NEAR(q["radiusRatio"], 1, tolerance);
  EXPECT_NEAR(q["radiusEdgeRatio"], std::sqrt(6.0) / 4, tolerance);
  EXPECT_NEAR(q["scaledJacobian"], 1, tolerance);
}

TEST(MeasureQuality, KnowsTheCornerOfACube) {
  auto q = measured(tet(corner));
  const double tolerance = 1e-12;
  EXPECT_NEAR(q["volume"], 1.0 / 6, tolerance);
  EXPECT_NEAR(q["edgeRatio"], std::sqrt(2.0), tolerance);
  EXPECT_NEAR(q["minDihedralAngle"], std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi, 1e-10);
  EXPECT_NEAR(q["maxDihedralAngle"], 90, 1e-10);
  // Circumradius sqrt(3)/2; inradius 3 V / area = 1/2 / (3/2 + sqrt(3)/2).
  EXPECT_NEAR(q["radiusRatio"], std::sqrt(3.0) / 2 * (3 + std::sqrt(3.0)) / 3, tolerance);
  EXPECT_NEAR(q["radiusEdgeRatio"], std::sqrt(3.0) / 2, tolerance);
  // At the right corner sqrt(2); at the others sqrt(2) / (1 * sqrt(2) * sqrt(2)).
  EXPECT_NEAR(q["scaledJacobian"], 1 / std::sqrt(2.0), tolerance);
}

TEST(MeasureQuality, AnInvertedTetrahedronIsNegativeAndAFlatOneFinite) {
  auto turned = measured(tet({corner[0], corner[2], corner[1], corner[3]}));
  EXPECT_NEAR(turned["volume"], -1.0 / 6, 1e-15);
  EXPECT_LT(turned["scaledJacobian"], 0);
  auto flat = measured(tet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(flat["volume"], 0);
  EXPECT_NEAR(flat["minDihedralAngle"], 0, 1e-12);
  EXPECT_NEAR(flat["maxDihedralAngle"], 180, 1e-12);
  for (const auto& [name, value] : flat) EXPECT_TRUE(std::isfinite(value)) << name;
}

/// The corner of a cube as tet10, the middle of the edge between corners 1 and 2 moved by (d d 0).
std::vector<Vec3> bulged(double d) {
  std::vector<Vec3> nodes = corner;
  constexpr std::size_t ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (const auto& e : ends) nodes.push_back((corner[e[0]] + corner[e[1]]) / 2);
  nodes[5] += Vec3(d, d, 0);
  return nodes;
}

TEST(MeasureQuality, StraightTet10IsMeasuredAsItsCorners) {
  auto straight = measured(tet(bulged(0)));
  for (const auto& [name, value] : measured(tet(corner))) EXPECT_NEAR(straight[name], value, 1e-12) << name;
}

TEST(MeasureQuality, ABulgedTet10HasTheVolumeOfItsMap) {
  // x = xi + d b(1,1,0) with b = 4 xi eta: det = 1 + 4 d (xi + eta), and the mean of xi + eta over the simplex is 1/2.
  const double d = 0.1;
  EXPECT_NEAR(measured(tet(bulged(d)))["volume"], (1 + 2 * d) / 6, 1e-14);
  EXPECT_GT(measured(tet(bulged(d)))["scaledJacobian"], 0);
}

TEST(MeasureQuality, ATet10FoldedBetweenItsNodesIsFound) {
  // det = 1 + 4 d (xi + eta) is negative near the edge from corner 1 to corner 2 once d < -1/4.
  EXPECT_GT(measured(tet(bulged(-0.24)))["scaledJacobian"], 0);
  EXPECT_LT(measured(tet(bulged(-0.26)))["scaledJacobian"], 0);
  EXPECT_GT(measured(tet(bulged(-0.26)))["volume"], 0);
}

TEST(MeasureQuality, ReportsPercentilesHistogramsAndTheWorstWithTheirPlaces) {
  Mesh mesh = five_tets();
  QuietReporter listener;
  const Value csv = run("MeasureMeshQuality",
                        {{"mesh", std::make_shared<const Mesh>(mesh)}, {"bins", Integer{2}}, {"worst", Integer{2}}},
                        &listener, "csv");
  const std::string& text = std::get<std::string>(csv);
  EXPECT_THAT(text, HasSubstr("measure,min,p1,p5,p25,p50,p75,p95,p99,max,mean\n"));
  // Four corners of edge ratio sqrt(2) and the regular one inside.
  EXPECT_THAT(text, HasSubstr("edgeRatio,1,1.01657,1.08284,1.41421,1.41421,1.41421,1.41421,1.41421,1.41421,1.33137\n"));
  EXPECT_THAT(text, HasSubstr("edgeRatio,1,3,5,1\nedgeRatio,3,5,0,0\n"));
  // The smallest volume, 1/6, is that of cell 0 with corners (0 0 0), (1 0 0), (0 1 0), (0 0 1).
  EXPECT_THAT(text, HasSubstr("volume,1,0,0.166667,0.25,0.25,0.25\n"));
  ASSERT_EQ(listener.printed.size(), 1u);
  EXPECT_EQ(listener.printed[0],
            "quality of 8 points, 5 tet4: volume 1, dihedral angles 54.7 to 90.0 degrees, edge ratio up to 1.41, "
            "radius-edge ratio up to 0.87, scaled Jacobian from 0.707, 0 inverted");
}

TEST(MeasureQuality, RefusesAMeshWithoutTetrahedra) {
  const Mesh triangles = to_mesh(box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(error_of("MeasureMeshQuality", {{"mesh", std::make_shared<const Mesh>(triangles)}}),
            "MeasureMeshQuality needs tetrahedra, but the mesh has 8 points, 12 tri3");
}

}  // namespace
}  // namespace msml::test
