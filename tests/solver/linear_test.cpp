// SPDX-License-Identifier: GPL-3.0-or-later
// Factorisations of matrices that Cholesky cannot take, against dense ones.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "solver/linear/linear_system.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using testing::Random;

/// A chain of nodes, each with its two neighbours on both sides, and random blocks.
struct Chain {
  explicit Chain(int nodes, bool symmetric) : matrix(make_pattern(nodes, triples(nodes), 3)) {
    Random random;
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
    for (int r = 0; r < 3 * nodes; ++r)
      for (int c = 0; c < 3 * nodes; ++c)
        if (std::abs(r / 3 - c / 3) <= 2) full(r, c) = random.number();
    dense = symmetric ? Eigen::MatrixXd(full + full.transpose()) : full;
    copy();
  }
  static std::vector<int> triples(int nodes) {
    std::vector<int> list;
    for (int n = 0; n + 2 < nodes; ++n) list.insert(list.end(), {n, n + 1, n + 2});
    return list;
  }
  void copy() {
    const Pattern& pattern = *matrix.pattern;
    for (int r = 0; r < pattern.nodes(); ++r)
      for (int p = pattern.offsets[static_cast<std::size_t>(r)]; p < pattern.offsets[static_cast<std::size_t>(r) + 1];
           ++p)
        for (int k = 0; k < 9; ++k)
          matrix.values[9 * static_cast<std::size_t>(p) + static_cast<std::size_t>(k)] =
              dense(3 * r + k / 3, 3 * pattern.columns[static_cast<std::size_t>(p)] + k % 3);
  }
  /// Rows and columns of the free unknowns.
  Eigen::MatrixXd free_part(const Mask& fixed) const {
    std::vector<int> keep;
    for (std::size_t k = 0; k < fixed.size(); ++k)
      if (!fixed[k]) keep.push_back(static_cast<int>(k));
    return dense(keep, keep);
  }
  Eigen::MatrixXd dense;
  BlockMatrix matrix;
};

Mask some_fixed(int nodes) {
  Mask fixed(static_cast<std::size_t>(3 * nodes), 0);
  for (const std::size_t k : {0u, 1u, 7u, 20u}) fixed[k] = 1;
  return fixed;
}

void expect_solved(const Chain& chain, const Mask& fixed, LinearSystem& system) {
  Random random;
  Vector b(chain.dense.rows()), x;
  for (Eigen::Index k = 0; k < b.size(); ++k) b[k] = random.number();
  ASSERT_EQ(system.solve(b, 1e-12, x), LinearStatus::done);
  const Vector left = chain.dense * x;
  for (Eigen::Index k = 0; k < b.size(); ++k)
    if (fixed[static_cast<std::size_t>(k)])
      EXPECT_EQ(x[k], 0);
    else
      EXPECT_NEAR(left[k], b[k], 1e-11);  // 1e-12 of |b|, which is about 8
}

TEST(IndefiniteFactorisation, SolvesAndCountsNegativeEigenvalues) {
  constexpr int nodes = 60;
  Chain chain(nodes, true);
  const Mask fixed = some_fixed(nodes);
  const auto system = make_indefinite(1);
  for (const double shift : {0.0, 2.0, 30.0}) {  // the second and third factor use the first analysis
    chain.dense.diagonal().array() += shift;
    chain.copy();
    ASSERT_EQ(system->factor(chain.matrix, fixed), LinearStatus::done);
    expect_solved(chain, fixed, *system);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(chain.free_part(fixed), Eigen::EigenvaluesOnly);
    EXPECT_EQ(system->negative_pivots(), (eigen.eigenvalues().array() < 0).count());
  }
}

TEST(IndefiniteFactorisation, TakesASaddlePointWithAnEmptyDiagonal) {
  constexpr int nodes = 40;
  Chain chain(nodes, true);
  for (int n = 0; n < nodes; ++n) chain.dense(3 * n + 2, 3 * n + 2) = 0;
  chain.copy();
  const Mask fixed(3 * nodes, 0);
  const auto system = make_indefinite(1);
  ASSERT_EQ(system->factor(chain.matrix, fixed), LinearStatus::done);
  expect_solved(chain, fixed, *system);
}

TEST(IndefiniteFactorisation, NamesASingularMatrix) {
  constexpr int nodes = 40;
  Chain chain(nodes, true);
  chain.dense.row(31).setZero();
  chain.dense.col(31).setZero();
  chain.copy();
  for (const auto& system : {make_indefinite(1), make_unsymmetric(1)})
    EXPECT_EQ(system->factor(chain.matrix, Mask(3 * nodes, 0)), LinearStatus::singular);
}

TEST(UnsymmetricFactorisation, Solves) {
  constexpr int nodes = 60;
  const Chain chain(nodes, false);
  const Mask fixed = some_fixed(nodes);
  const auto system = make_unsymmetric(1);
  ASSERT_EQ(system->factor(chain.matrix, fixed), LinearStatus::done);
  expect_solved(chain, fixed, *system);
}

TEST(EveryFactorisation, HasNothingToDoWhereAllIsFixed) {
  const Chain chain(4, true);
  Vector x;
  for (const auto& system : {make_indefinite(1), make_unsymmetric(1)}) {
    EXPECT_EQ(system->factor(chain.matrix, Mask(12, 1)), LinearStatus::done);
    EXPECT_EQ(system->solve(Vector::Ones(12), 1e-10, x), LinearStatus::done);
    EXPECT_EQ(x.norm(), 0);
  }
}

// Larger than what it may take, a factor is refused before it is computed: the system would end the whole program.
TEST(Cholesky, RefusesAFactorThatDoesNotFit) {
  constexpr int nodes = 60;
  Chain chain(nodes, true);
  chain.dense.diagonal().array() += 100;  // larger than the sum of the others in its row: positive definite
  chain.copy();
  const Mask fixed = some_fixed(nodes);
  const auto roomy = make_cholesky(1);
  ASSERT_EQ(roomy->factor(chain.matrix, fixed), LinearStatus::done);
  expect_solved(chain, fixed, *roomy);
  const auto exact = make_cholesky(1, roomy->factor_bytes()), narrow = make_cholesky(1, roomy->factor_bytes() - 1);
  EXPECT_EQ(exact->factor(chain.matrix, fixed), LinearStatus::done);
  EXPECT_EQ(narrow->factor(chain.matrix, fixed), LinearStatus::out_of_memory);
  EXPECT_EQ(narrow->factor_bytes(), 0U);
}

TEST(AvailableMemory, IsSomeAndNotMoreThanAnyMachineHas) {
  EXPECT_GT(available_memory(), std::size_t{1} << 20);
  EXPECT_LT(available_memory(), std::size_t{1} << 50);
}

}  // namespace
}  // namespace msml::fe
