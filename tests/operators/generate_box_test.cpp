// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateBoxMesh against counts and volumes known by construction.
#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

using Numbers = std::vector<double>;
using Integers = std::vector<Integer>;

const Arguments slab{{"origin", Numbers{1, 2, 3}}, {"size", Numbers{2, 1, 0.5}}, {"divisions", Integers{4, 3, 2}}};

TEST(GenerateBox, HasSixTetrahedraPerCellAndAllLatticePoints) {
  const auto mesh = output<Mesh>(run("GenerateBoxMesh", slab));
  EXPECT_EQ(mesh->count(CellKind::tet4), 6 * 4 * 3 * 2);
  EXPECT_EQ(mesh->point_count(), 5 * 4 * 3);
  EXPECT_NO_THROW(mesh->check());
}

TEST(GenerateBox, FillsTheBoxWithPositiveTetrahedra) {
  const auto mesh = output<Mesh>(run("GenerateBoxMesh", slab));
  EXPECT_GT(smallest_volume(*mesh), 0);
  EXPECT_NEAR(total_volume(*mesh), 2 * 1 * 0.5, 1e-12);  // round-off of 144 terms
  EXPECT_EQ(mesh->points.colwise().minCoeff(), Eigen::RowVector3d(1, 2, 3));
  EXPECT_EQ(mesh->points.colwise().maxCoeff(), Eigen::RowVector3d(3, 3, 3.5));
}

TEST(GenerateBox, IsOneBodyWithASphereForBoundary) {
  const auto mesh = output<Mesh>(run("GenerateBoxMesh", slab));
  EXPECT_EQ(euler_characteristic(*mesh), 1);  // of a ball
  // Two triangles for each of 2 (4*3 + 3*2 + 4*2) squares: neighbouring cells fit.
  EXPECT_EQ(boundary_faces(*mesh), 2 * 2 * (12 + 6 + 8));
}

TEST(GenerateBox, QuadraticHasAMidNodeOnEveryEdge) {
  Arguments arguments = slab;
  arguments["quadratic"] = true;
  const auto mesh = output<Mesh>(run("GenerateBoxMesh", arguments));
  EXPECT_EQ(mesh->count(CellKind::tet10), 144);
  // Points of the lattice of half the spacing: every edge of Kuhn's partition has its middle there, and each is one.
  EXPECT_EQ(mesh->point_count(), 9 * 7 * 5);
}

}  // namespace
}  // namespace msml::test
