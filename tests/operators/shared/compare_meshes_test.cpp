// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/compare_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>

#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

using operators::compare;
using operators::Comparison;
using Law = std::function<Vec3(const Vec3&)>;

/// n x n x n cubes of [0, 1]^3, six tets each, tet4 or straight tet10.
Mesh cube(int n, bool quadratic) {
  Mesh mesh;
  const auto id = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) points.emplace_back(Vec3(i, j, k) / n);
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [place, fresh] = middles.emplace(std::minmax(a, b), static_cast<int>(points.size()));
    if (fresh) points.push_back(0.5 * (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]));
    return place->second;
  };
  const int paths[6][2] = {{1, 3}, {3, 2}, {2, 6},
                           {6, 4}, {4, 5}, {5, 1}};  // corners of a ring around the diagonal 0-7
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto corner = [&](int c) { return id(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)); };
        for (const auto& p : paths) {
          std::vector<int> t{corner(0), corner(p[0]), corner(p[1]), corner(7)};
          if (quadratic)
            for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}})
              t.push_back(middle(t[static_cast<std::size_t>(a)], t[static_cast<std::size_t>(b)]));
          mesh.add_cell(quadratic ? CellKind::tet10 : CellKind::tet4, t.data());
        }
      }
  mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) mesh.points.row(static_cast<Eigen::Index>(i)) = points[i];
  return mesh;
}

/// The mesh deformed by the law, with the field "displacement".
Mesh deformed(Mesh mesh, const Law& law) {
  Field u{.name = "displacement", .components = 3};
  for (int i = 0; i < mesh.point_count(); ++i) {
    const Vec3 value = law(mesh.points.row(i));
    u.values.insert(u.values.end(), value.data(), value.data() + 3);
    mesh.points.row(i) += value.transpose();
  }
  mesh.point_fields.push_back(std::move(u));
  return mesh;
}

const Law linear = [](const Vec3& x) { return Vec3(0.3 * x[0] - 0.1 * x[1], 0.2 * x[2], 0.5 + 0.4 * x[0]); };
const Law quadratic = [](const Vec3& x) { return Vec3(x[0] * x[0], x[0] * x[1], x[2] * x[2] - x[1]); };

TEST(CompareMeshes, AMeshEqualsItself) {
  const Mesh mesh = deformed(cube(2, true), quadratic);
  const Comparison c = compare(mesh, mesh);
  EXPECT_TRUE(c.by_node);
  ASSERT_EQ(c.fields.size(), 1U);
  EXPECT_EQ(c.max(), 0);
  EXPECT_EQ(c.fields[0].l2, 0);
}

TEST(CompareMeshes, AConstantDifferenceHasEqualNormsOnTheUnitCube) {
  for (const bool second_order : {false, true}) {
    const Mesh a = deformed(cube(2, second_order), [](const Vec3& x) { return Vec3(linear(x) + Vec3(0, 3, 4)); });
    const Comparison c = compare(a, deformed(cube(2, second_order), linear));
    EXPECT_TRUE(c.by_node);  // although the deformed points differ
    EXPECT_NEAR(c.fields[0].max, 5, 1e-12);
    EXPECT_NEAR(c.fields[0].rms, 5, 1e-12);
    EXPECT_NEAR(c.fields[0].l2, 5, 1e-12);  // the cube has volume 1
  }
}

TEST(CompareMeshes, TheL2NormIntegratesALinearDifferenceExactly) {
  const Mesh a = deformed(cube(3, false), [](const Vec3& x) { return Vec3(linear(x) + Vec3(0, x[1], 0)); });
  const Comparison c = compare(a, deformed(cube(3, false), linear));
  EXPECT_NEAR(c.fields[0].l2, std::sqrt(1.0 / 3.0), 1e-12);  // integral of y^2 over the unit cube
}

TEST(CompareMeshes, TheWorstNodeIsNamedWithItsReferencePlace) {
  Mesh a = deformed(cube(2, false), linear);
  const Mesh b = a;
  a.point_fields[0].values[3 * 26 + 1] += 0.25;  // the last node, at (1 1 1)
  a.points(26, 1) += 0.25;
  const Comparison c = compare(a, b);
  EXPECT_TRUE(c.by_node);
  EXPECT_EQ(c.fields[0].where_id, 26);
  EXPECT_NEAR((c.fields[0].where - Vec3::Ones()).norm(), 0, 1e-12);
  EXPECT_DOUBLE_EQ(c.fields[0].max, 0.25);
  EXPECT_DOUBLE_EQ(c.fields[0].rms, 0.25 / std::sqrt(27));
}

TEST(CompareMeshes, ALinearFieldIsInterpolatedExactlyBetweenDifferentMeshes) {
  for (const bool a_quadratic : {false, true})
    for (const bool b_quadratic : {false, true}) {
      const Comparison c = compare(deformed(cube(2, a_quadratic), linear), deformed(cube(3, b_quadratic), linear));
      EXPECT_FALSE(c.by_node);
      EXPECT_EQ(c.outside, 0U);
      EXPECT_LT(c.max(), 1e-12);  // round-off
    }
}

TEST(CompareMeshes, AQuadraticFieldIsInterpolatedExactlyInTet10AndNotInTet4) {
  const Mesh fine = deformed(cube(3, true), quadratic);
  EXPECT_LT(compare(deformed(cube(2, true), quadratic), fine).max(), 1e-12);
  EXPECT_GT(compare(deformed(cube(2, false), quadratic), fine).max(), 0.01);  // h^2 / 8 = 1/32 at mid edges
}

TEST(CompareMeshes, NodesOutsideAreCountedAndTakeTheNearestValue) {
  Mesh b = cube(3, false);
  b.points.col(0) *= 1.25;  // the last of four layers of 16 nodes leaves A by 0.25; the third is at 5/6
  const Law constant = [](const Vec3&) { return Vec3(1, 2, 3); };
  const Comparison c = compare(deformed(cube(2, false), constant), deformed(b, constant));
  EXPECT_EQ(c.outside, 16U);
  EXPECT_NEAR(c.outside_distance, 0.25, 1e-12);
  EXPECT_LT(c.max(), 1e-12);
}

TEST(CompareMeshes, CellFieldsAndRegionsAreComparedByVolume) {
  Mesh a = test::five_tets(), b = a;
  a.cell_fields = {{.name = "energy", .values = {1, 1, 1, 1, 4}}};
  b.cell_fields = {{.name = "energy", .values = {1, 1, 1, 1, 1}}};
  a.regions = b.regions = {1, 2, 3, 4, 5};
  const Comparison c = compare(a, b);
  ASSERT_EQ(c.fields.size(), 2U);
  EXPECT_TRUE(c.fields[0].on_cells);
  EXPECT_NEAR(c.fields[0].l2, 3 * std::sqrt(1.0 / 3.0), 1e-14);  // the middle tet has a third of the cube
  EXPECT_EQ(c.fields[0].where_id, 4);
  EXPECT_EQ(c.fields[1].name, "region");
  EXPECT_EQ(c.fields[1].max, 0);
}

TEST(CompareMeshes, FieldsWithoutAPartnerAreNamed) {
  Mesh a = test::five_tets(), b = a;
  a.cell_fields = {{.name = "left", .values = {0, 0, 0, 0, 0}}};
  b.point_fields = {{.name = "right", .values = std::vector<double>(8)}};
  const Comparison c = compare(a, b);
  EXPECT_THAT(c.only_in_a, testing::ElementsAre("left"));
  EXPECT_THAT(c.only_in_b, testing::ElementsAre("right"));
  EXPECT_TRUE(c.fields.empty());
}

}  // namespace
}  // namespace msml
