// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices in half precision: their products, and where the multigrid cycle takes them.
#include "solver/linear/multigrid/halves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "solver/equations.hpp"
#include "solver/linear/multigrid/multigrid.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {
namespace {

bool widens_halves() {
  Sparsity one;
  one.width = 1, one.columns = {0}, one.offsets = {0, 1};
  Halves halves;
  halves.allocate(one);
  return !halves.empty();
}

// Rounding to eleven digits changes each number by at most 2^-11 of itself, or in numbers below 2^-29 of the row's
// largest, which are off by a fixed amount, by 2^-39 of that one.
TEST(Halves, HaveProductsWithinTheirRounding) {
  if (!widens_halves()) GTEST_SKIP() << "this processor does not widen halves";
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-1, 1);
  Sparsity sparsity;
  sparsity.width = 40;
  for (int r = 0; r < 60; ++r) {
    for (int k = 0; k < r % 7; ++k) sparsity.columns.push_back((r + 5 * k) % sparsity.width);
    sparsity.offsets.push_back(static_cast<int>(sparsity.columns.size()));
  }
  std::vector<float> x(3 * static_cast<std::size_t>(sparsity.width) + 8, NAN);  // what follows must not count
  for (std::size_t k = 0; k < 3 * static_cast<std::size_t>(sparsity.width); ++k) x[k] = number(random);
  Halves halves;
  halves.allocate(sparsity);
  for (int r = 0; r < sparsity.rows(); ++r) {
    const float size = std::pow(10.0f, static_cast<float>(r % 41 - 20));  // rows of 1e-20 and of 1e20
    const int begin = sparsity.offsets[static_cast<std::size_t>(r)];
    const int count = sparsity.offsets[static_cast<std::size_t>(r) + 1] - begin;
    std::vector<float> blocks(9 * static_cast<std::size_t>(count) + 1);
    for (std::size_t k = 0; k < blocks.size(); ++k) blocks[k] = size * number(random) * (k % 5 == 0 ? 1e-6f : 1.0f);
    halves.set_row(sparsity, r, blocks.data());
    double sum[3] = {}, bound[3] = {};
    for (int p = 0; p < count; ++p)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const double a = blocks[static_cast<std::size_t>(9 * p + 3 * j + i)];
          const double v = x[static_cast<std::size_t>(3 * sparsity.columns[static_cast<std::size_t>(begin + p)] + j)];
          sum[i] += a * v;
          bound[i] += (std::ldexp(1.0, -11) * std::abs(a) + std::ldexp(size, -39)) * std::abs(v);
        }
    const Single4 product = halves.row_product(sparsity, r, x.data());
    for (int i = 0; i < 3; ++i)
      EXPECT_LE(std::abs(static_cast<double>(product[i]) - sum[i]), 1.01 * bound[i]) << "row " << r;
  }
}

/// A clamped bar of 100 : 1 with `mass` times its mass matrix beside its stiffness.
struct Bar {
  Bar(CellKind kind, double poisson_ratio, double mass)
      : model(make_model(
            kind == CellKind::tet4 ? box_mesh(200, 2, 2, {100, 1, 1}, kind) : box_mesh(100, 1, 1, {100, 1, 1}, kind),
            {.youngs_modulus = 1, .poisson_ratio = poisson_ratio, .strain = Strain::small})),
        equations(model),
        A(equations.elements().pattern()) {
    Forces forces;
    const Vector zero = Vector::Zero(equations.size());
    equations.evaluate(zero, {}, Want::tangent, forces, &A);
    add(A, mass, equations.mass());
    fixed.assign(static_cast<std::size_t>(equations.size()), 0);
    for (std::size_t k = 0; k < fixed.size(); ++k)
      fixed[k] = equations.positions()[static_cast<Eigen::Index>(k / 3 * 3)] < 1e-9;
  }
  bool in_halves() const {
    Multigrid grids(equations.geometry());
    EXPECT_EQ(grids.set(A, fixed), LinearStatus::done);
    return grids.in_halves();
  }
  double iterations() const {
    const auto system = make_multigrid(equations.geometry());
    Vector x;
    EXPECT_EQ(system->factor(A, fixed), LinearStatus::done);
    EXPECT_EQ(system->solve(Vector::LinSpaced(equations.size(), -1, 2), 1e-6, x), LinearStatus::done);
    return static_cast<double>(system->iterations);
  }
  Model model;
  Equations equations;
  BlockMatrix A;
  Mask fixed;
};

bool halved(CellKind kind, double poisson_ratio, double mass) { return Bar(kind, poisson_ratio, mass).in_halves(); }

/// The largest mass without and the smallest one with halves.
std::pair<double, double> beginning(CellKind kind, double poisson_ratio) {
  double without = 1e-12, with = 1;
  EXPECT_TRUE(halved(kind, poisson_ratio, with));
  EXPECT_FALSE(halved(kind, poisson_ratio, without));
  while (with > 1.01 * without) {
    const double middle = std::sqrt(with * without);
    (halved(kind, poisson_ratio, middle) ? with : without) = middle;
  }
  return {without, with};
}

// Where mass / dt^2 is large enough at every node; not in statics. There, such a bar takes several times as many
// iterations with halves; where they begin it hardly takes more than without.
TEST(Halves, BeginWhereTheyHardlyCostIterations) {
  if (!widens_halves()) GTEST_SKIP() << "this processor does not widen halves";
  for (const auto& [kind, poisson_ratio] :
       {std::pair{CellKind::tet4, 0.3}, {CellKind::tet4, 0.49}, {CellKind::tet10, 0.3}}) {
    const auto [without, with] = beginning(kind, poisson_ratio);
    EXPECT_LE(Bar(kind, poisson_ratio, with).iterations(), 1.2 * Bar(kind, poisson_ratio, without).iterations() + 1)
        << name(kind) << ", nu = " << poisson_ratio << ", mass " << with;
  }
  EXPECT_FALSE(halved(CellKind::tet10, 0.49, 1));
}

// Two bytes a number instead of four, and one scale a row.
TEST(Halves, TakeHalfTheMemory) {
  if (!widens_halves()) GTEST_SKIP() << "this processor does not widen halves";
  const Bar bar(CellKind::tet4, 0.3, 1);
  const auto bytes = [&](bool halved) {
    Level<3> level;
    level.halved = halved;
    EXPECT_TRUE(level.set(FreeBlocks{bar.A, bar.fixed}));
    return level.bytes();
  };
  const std::size_t saved = 2 * bar.A.values.size();
  EXPECT_LT(bytes(true) + saved / 2, bytes(false));
}

// A soft half that is nearly incompressible does not lower what is asked of the other one.
TEST(Halves, BeginWithTheSmallestPoissonRatio) {
  if (!widens_halves()) GTEST_SKIP() << "this processor does not widen halves";
  const auto in_halves_with = [](double mass) {
    Bar bar(CellKind::tet4, 0.3, 0);
    Region half = bar.model.regions[0];
    std::vector<int>& all = bar.model.regions[0].elements;
    half.elements.assign(all.begin() + static_cast<long>(all.size() / 2), all.end());
    half.law = make_linear_elastic({.youngs_modulus = 0.01, .poisson_ratio = 0.49, .strain = Strain::small});
    all.resize(all.size() / 2);
    bar.model.regions.push_back(half);
    const Equations equations(bar.model);
    BlockMatrix A(equations.elements().pattern());
    Forces forces;
    equations.evaluate(Vector::Zero(equations.size()), {}, Want::tangent, forces, &A);
    add(A, mass, equations.mass());
    Multigrid grids(equations.geometry());
    EXPECT_EQ(grids.set(A, bar.fixed), LinearStatus::done);
    return grids.in_halves();
  };
  const double mass = 0.5 * beginning(CellKind::tet4, 0.3).first;
  EXPECT_FALSE(in_halves_with(mass));
  EXPECT_TRUE(in_halves_with(100 * mass));
}

}  // namespace
}  // namespace msml::fe::testing
