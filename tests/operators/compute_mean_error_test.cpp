// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

Value moved(const Vec3& shift) {
  Mesh mesh = test::five_tets();
  mesh.points.rowwise() += shift.transpose();
  return std::make_shared<const Mesh>(std::move(mesh));
}

/// The cube of five tets with one more point in its middle that belongs to a tet, moved by `inner`.
Value with_inner(const Vec3& shift, const Vec3& inner) {
  Mesh mesh = test::five_tets();
  mesh.points.conservativeResize(9, 3);
  mesh.points.row(8).setConstant(0.5);
  const std::vector<int> last(mesh.nodes.end() - 4, mesh.nodes.end());  // the middle tet becomes four
  mesh.kinds.pop_back();
  mesh.offsets.pop_back();
  mesh.nodes.resize(mesh.nodes.size() - 4);
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<int> tet = last;
    tet[k] = 8;
    mesh.add_cell(CellKind::tet4, tet.data());
  }
  mesh.points.rowwise() += shift.transpose();
  mesh.points.row(8) += inner.transpose();
  return std::make_shared<const Mesh>(std::move(mesh));
}

double error(const Value& initial, const Value& reference, const Value& test, bool surface_only = false) {
  return std::get<double>(msml::test::run(
      "ComputeMeanError",
      {{"initialMesh", initial}, {"referenceMesh", reference}, {"testMesh", test}, {"surfaceOnly", surface_only}}));
}

TEST(ComputeMeanError, RelatesTheMeanDifferenceToTheMeanMotionWhateverTheNumberOfNodes) {
  EXPECT_NEAR(error(moved({0, 0, 0}), moved({0, 0, 4}), moved({0, 3, 4})), 3.0 / 4.0, 1e-15);
  EXPECT_NEAR(error(moved({0, 0, 0}), moved({0, 0, 4}), moved({0, 0, 0})), 1, 1e-15);
  EXPECT_EQ(error(moved({0, 0, 0}), moved({0, 0, 4}), moved({0, 0, 4})), 0);
}

TEST(ComputeMeanError, LeavesInnerNodesOutOnRequest) {
  const Vec3 none = Vec3::Zero(), one(0, 0, 1);
  const Value initial = with_inner(none, none), reference = with_inner(one, none), test = with_inner(one, {9, 0, 0});
  EXPECT_NEAR(error(initial, reference, test), 9.0 / 9.0, 1e-15);  // one of nine nodes is off by nine
  EXPECT_EQ(error(initial, reference, test, true), 0);
}

TEST(ComputeMeanError, NeedsTheSameNodesAndSomeMotion) {
  EXPECT_EQ(test::error_of("ComputeMeanError", {{"initialMesh", moved({0, 0, 0})},
                                                {"referenceMesh", with_inner({0, 0, 1}, {0, 0, 0})},
                                                {"testMesh", moved({0, 0, 0})}}),
            "referenceMesh has 9 points, initialMesh 8; the meshes must have the same nodes");
  EXPECT_EQ(
      test::error_of(
          "ComputeMeanError",
          {{"initialMesh", moved({0, 0, 0})}, {"referenceMesh", moved({0, 0, 0})}, {"testMesh", moved({1, 0, 0})}}),
      "no node of the 8 compared moves from initialMesh to referenceMesh, so there is nothing to relate the error to");
}

}  // namespace
}  // namespace msml
