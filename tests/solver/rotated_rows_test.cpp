// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices that are summed block by block, beside those that elements add to one by one.
#include "solver/elements/rotated_rows.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "solver/elements/gradient_products.hpp"
#include "solver/equations.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {
namespace {

/// A bent and twisted beam of two halves with their own moduli, one of them auxetic (lambda < 0); quadratic elements
/// have a rotation each.
Model two_halves(CellKind kind) {
  Model model = beam_model(3, kind, 0.3, Strain::corotated);
  if (kind == CellKind::tet10) model.formulation = Formulation::single_rotation;
  Region soft{.name = "soft",
              .law = make_linear_elastic({.youngs_modulus = 2e4, .poisson_ratio = -0.2, .strain = Strain::corotated}),
              .density = 1000};
  std::vector<int>& all = model.regions[0].elements;
  const auto middle = all.begin() + static_cast<long>(all.size() / 2);
  soft.elements.assign(middle, all.end());
  all.erase(middle, all.end());
  model.regions.push_back(soft);
  return model;
}

Vector twisted(const Equations& equations) {
  Vector u(equations.size());
  for (Eigen::Index k = 0; k < u.size(); k += 3) {
    const Vec3 X = equations.positions().segment<3>(k);
    const double angle = 8 * X[0];
    u.segment<3>(k) = Vec3(0.1 * X[0], X[1] * (std::cos(angle) - 1) - X[2] * std::sin(angle) + 2 * X[0] * X[0],
                           X[1] * std::sin(angle) + X[2] * (std::cos(angle) - 1));
  }
  return u;
}

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

/// Largest difference of entries beside the largest entry.
double difference(const BlockMatrix& A, const BlockMatrix& B) {
  double largest = 0, apart = 0;
  for (std::size_t k = 0; k < A.values.size(); ++k) {
    largest = std::max(largest, std::abs(A.values[k]));
    apart = std::max(apart, std::abs(A.values[k] - B.values[k]));
  }
  return apart / largest;
}

class RotatedRows : public ::testing::TestWithParam<CellKind> {};
INSTANTIATE_TEST_SUITE_P(All, RotatedRows, ::testing::Values(CellKind::tet4, CellKind::tet10),
                         [](const auto& kind) { return std::string(name(kind.param)); });

TEST_P(RotatedRows, AreTheSumsOfTheElements) {
  const Model model = two_halves(GetParam());
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

TEST_P(RotatedRows, AreSymmetricToTheLastBit) {
  const Model model = two_halves(GetParam());
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

TEST_P(RotatedRows, DoNotDependOnTheNumberOfThreads) {
  const Model model = two_halves(GetParam());
  const Equations equations(model);
  const Vector u = twisted(equations);
  Numbers<double> alone, together;
  tbb::task_arena(1).execute([&] { alone = three_times(equations, u).matrices[2].values; });
  tbb::task_arena(2).execute([&] { together = three_times(equations, u).matrices[2].values; });
  EXPECT_EQ(alone, together);
}

// In a time step the stiffness is what relaxation leaves of it, here in one half.
TEST(RelaxingRows, AreTheSumsOfTheElements) {
  Model model = two_halves(CellKind::tet10);
  model.regions[1].prony = {.g = {0.6}, .tau = {0.1}};
  Equations equations(model);
  equations.begin_step(0.05);
  const std::size_t bytes = equations.elements().bytes();
  const Sums sums = three_times(equations, twisted(equations));
  ASSERT_GT(equations.elements().bytes(), bytes);
  EXPECT_LT(difference(sums.matrices[0], sums.matrices[2]), 1e-13);
}

// One curved edge is enough: its elements keep their stiffness.
TEST(CurvedElements, AreNotSummedByRows) {
  Model model = two_halves(CellKind::tet10);
  Mesh mesh = *model.mesh;
  mesh.points(mesh.cell(0)[4], 2) += 1e-4;
  model.mesh = std::make_shared<const Mesh>(mesh);
  const Equations equations(model);
  const std::size_t bytes = equations.elements().bytes();
  const Sums sums = three_times(equations, twisted(equations));
  EXPECT_EQ(equations.elements().bytes(), bytes);
  EXPECT_EQ(difference(sums.matrices[0], sums.matrices[2]), 0);
}

// The four-point rule is exact for products of linear functions.
TEST(GradientProducts, AreTheMeansOverATetrahedron) {
  const Rule<3> rule = stiffness_rule<3, 10>();
  const auto corners = Tetrahedron<4>::gradients({});
  const auto G = [&](int a, int i) {
    const auto at = [&](int corner) { return corners[static_cast<std::size_t>(corner)][static_cast<std::size_t>(i)]; };
    const auto ends = Tetrahedron<10>::edges[static_cast<std::size_t>(std::max(a - 4, 0))];
    return a < 4 ? at(a) : at(ends[0]) + at(ends[1]);
  };
  for (int a = 0; a < 10; ++a)
    for (int b = 0; b < 10; ++b)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          double mean = 0;
          for (const auto& point : rule) {
            const auto g = Tetrahedron<10>::gradients(point.xi);
            mean += 6 * point.weight * g[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] *
                    g[static_cast<std::size_t>(b)][static_cast<std::size_t>(j)];
          }
          const GradientProduct& product = gradient_products<10>[static_cast<std::size_t>(16 * a + b)];
          double sum = product.first * G(a, i) * G(b, j);
          for (std::size_t n = 0; n < static_cast<std::size_t>(product.count); ++n)
            sum += product.second * G(product.pairs[n][0], i) * G(product.pairs[n][1], j);
          EXPECT_NEAR(sum, mean, 1e-14) << a << " " << b;
        }
}

}  // namespace
}  // namespace msml::fe::testing
