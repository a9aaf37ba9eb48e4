// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateSegmentMesh against counts and places known by construction.
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

const Arguments rod{{"origin", std::vector<double>{1, 2, 3}}, {"length", 0.7}, {"divisions", Integer{7}}};

TEST(GenerateSegment, HasEqualElementsAlongX) {
  const auto mesh = output<Mesh>(run("GenerateSegmentMesh", rod));
  EXPECT_EQ(mesh->count(CellKind::line2), 7);
  EXPECT_EQ(mesh->count(CellKind::vertex), 2);
  for (int i = 0; i <= 7; ++i)
    EXPECT_NEAR((mesh->points.row(i) - Eigen::RowVector3d(1 + 0.1 * i, 2, 3)).norm(), 0, 1e-15);
  EXPECT_EQ(mesh->points(7, 0), 1.7);
}

TEST(GenerateSegment, QuadraticHasAMidNodeInEveryElement) {
  Arguments arguments = rod;
  arguments["quadratic"] = true;
  const auto mesh = output<Mesh>(run("GenerateSegmentMesh", arguments));
  EXPECT_EQ(mesh->count(CellKind::line3), 7);
  EXPECT_EQ(mesh->point_count(), 15);
  const int* nodes = mesh->cell(0);
  EXPECT_NEAR(mesh->points(nodes[2], 0), 1.05, 1e-15);
}

}  // namespace
}  // namespace msml::test
