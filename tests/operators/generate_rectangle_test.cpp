// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateRectangleMesh against counts and areas known by construction.
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

const Arguments plate{{"origin", std::vector<double>{1, 2, 3}},
                      {"size", std::vector<double>{2, 1}},
                      {"divisions", std::vector<Integer>{4, 3}}};

TEST(GenerateRectangle, FillsTheRectangleWithTrianglesThatLookUp) {
  const auto mesh = output<Mesh>(run("GenerateRectangleMesh", plate));
  EXPECT_EQ(mesh->count(CellKind::tri3), 2 * 4 * 3);
  EXPECT_EQ(mesh->count(CellKind::line2), 2 * (4 + 3));
  EXPECT_EQ(mesh->point_count(), 5 * 4);
  EXPECT_NO_THROW(mesh->check());
  double area = 0;
  for (int c = 0; c < mesh->cell_count(); ++c) {
    if (mesh->kinds[static_cast<std::size_t>(c)] != CellKind::tri3) continue;
    const int* n = mesh->cell(c);
    const Eigen::RowVector3d a = mesh->points.row(n[1]) - mesh->points.row(n[0]),
                             b = mesh->points.row(n[2]) - mesh->points.row(n[0]);
    const double twice = a[0] * b[1] - a[1] * b[0];
    EXPECT_GT(twice, 0);
    area += twice / 2;
  }
  EXPECT_NEAR(area, 2, 1e-14);
  EXPECT_EQ(mesh->points.colwise().minCoeff(), Eigen::RowVector3d(1, 2, 3));
  EXPECT_EQ(mesh->points.colwise().maxCoeff(), Eigen::RowVector3d(3, 3, 3));
}

TEST(GenerateRectangle, QuadraticHasAMidNodeOnEveryEdge) {
  Arguments arguments = plate;
  arguments["quadratic"] = true;
  const auto mesh = output<Mesh>(run("GenerateRectangleMesh", arguments));
  EXPECT_EQ(mesh->count(CellKind::tri6), 24);
  EXPECT_EQ(mesh->count(CellKind::line3), 14);
  EXPECT_EQ(mesh->point_count(), 9 * 7);
}

}  // namespace
}  // namespace msml::test
