// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices that are summed block by block, beside those that elements add to one by one.
#include "solver/elements/rotated_rows.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "solver/equations.hpp"
#include "tests/solver/two_halves.hpp"

namespace msml::fe::testing {
namespace {

struct Sums {
  std::vector<BlockMatrix> matrices;  ///< the first two by elements, the third by rows
  std::vector<Vector> forces;
  std::vector<Assembled> found;
};

Sums three_times(const Equations& equations, const Vector& u) {
  Sums sums;
  for (int k = 0; k < 3; ++k) {
    sums.matrices.emplace_back(equations.elements().pattern());
    sums.forces.push_back(Vector::Zero(u.size()));
    sums.found.push_back(
        equations.elements().add_internal(u, Want::single_tangent, sums.forces.back(), &sums.matrices.back()));
  }
  return sums;
}

TEST(RotatedRows, AreTheSumsOfTheElements) {
  const Model model = two_halves(CellKind::tet4);
  const Equations equations(model);
  const std::size_t bytes = equations.elements().bytes();
  const Sums sums = three_times(equations, twisted(equations));
  ASSERT_GT(equations.elements().bytes(), bytes) << "the third matrix was not summed by rows";
  EXPECT_LT(difference(sums.matrices[0], sums.matrices[2]), 1e-13);
  EXPECT_LT((sums.forces[2] - sums.forces[0]).norm(), 1e-14 * sums.forces[0].norm());
  EXPECT_NEAR(sums.found[2].energy, sums.found[0].energy, 1e-13 * sums.found[0].energy);
  EXPECT_EQ(sums.found[2].smallest_J, sums.found[0].smallest_J);
  EXPECT_EQ(sums.found[2].smallest_J_element, sums.found[0].smallest_J_element);
}

TEST(RotatedRows, AreSymmetricToTheLastBit) {
  const Model model = two_halves(CellKind::tet4);
  const Equations equations(model);
  const BlockMatrix K = three_times(equations, twisted(equations)).matrices[2];
  const Pattern& pattern = *K.pattern;
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int p = pattern.offsets[static_cast<std::size_t>(row)]; p < pattern.offsets[static_cast<std::size_t>(row) + 1];
         ++p) {
      const int other = pattern.find(pattern.columns[static_cast<std::size_t>(p)], row);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          ASSERT_EQ(K.values[9 * static_cast<std::size_t>(p) + 3 * i + j],
                    K.values[9 * static_cast<std::size_t>(other) + 3 * j + i]);
    }
}

TEST(RotatedRows, DoNotDependOnTheNumberOfThreads) {
  const Model model = two_halves(CellKind::tet4);
  const Equations equations(model);
  const Vector u = twisted(equations);
  Numbers<double> alone, together;
  tbb::task_arena(1).execute([&] { alone = three_times(equations, u).matrices[2].values; });
  tbb::task_arena(2).execute([&] { together = three_times(equations, u).matrices[2].values; });
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace msml::fe::testing
