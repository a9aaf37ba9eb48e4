// SPDX-License-Identifier: GPL-3.0-or-later
// ExtractPointPositions on the corners of a cube.
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

Arguments corners(std::vector<int> ids, Indexed kind = Indexed::nodes) {
  return {{"mesh", std::make_shared<const Mesh>(five_tets())},
          {"indices", std::make_shared<const IndexSet>(IndexSet{kind, std::move(ids), nullptr})}};
}

TEST(ExtractPointPositions, FollowsTheOrderOfTheIds) {
  const Value points = run("ExtractPointPositions", corners({7, 1}));
  EXPECT_EQ(std::get<std::vector<double>>(points), (std::vector<double>{1, 1, 1, 1, 0, 0}));
}

TEST(ExtractPointPositions, RefusesIdsThatAreNoPoints) {
  EXPECT_EQ(error_of("ExtractPointPositions", corners({8})), "indices name point 8, but the mesh has points 0 to 7");
  EXPECT_EQ(error_of("ExtractPointPositions", corners({0}, Indexed::elements)),
            "indices are ids of elements, but ExtractPointPositions needs ids of nodes");
}

}  // namespace
}  // namespace msml::test
