// SPDX-License-Identifier: GPL-3.0-or-later
// Tangents that elements keep, beside their matrices; and time steps that multiply without a matrix.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <random>

#include "solver/elements/gradient_products.hpp"
#include "solver/linear/linear_system.hpp"
#include "solver/newton.hpp"
#include "tests/solver/two_halves.hpp"

namespace msml::fe::testing {
namespace {

constexpr double inertia = 1e4;

Vector random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  Vector v(size);
  for (double& value : v) value = std::uniform_real_distribution<double>(-1, 1)(random);
  return v;
}

/// The tangent R K R^T of a twisted beam as a matrix, and kept by the elements.
struct Both {
  explicit Both(const Model& model, double dt = 0)
      : equations(model),
        u(twisted(equations)),
        matrix(equations.elements().pattern()),
        room(equations.elements().pattern()) {
    if (dt > 0) equations.begin_step(dt);
    force = kept_force = Vector::Zero(u.size());
    found = equations.elements().add_internal(u, Want::single_tangent, force, &matrix);
    kept_found = equations.elements().add_internal(u, Want::single_tangent, kept_force, nullptr);
  }
  EffectiveProducts products() { return {*equations.elements().kept_tangent(), inertia, equations.mass(), room}; }

  Equations equations;
  Vector u, force, kept_force;
  BlockMatrix matrix, room;
  Assembled found, kept_found;
};

/// Times one vector and times eight, with inertia.
void expect_products(Both& both) {
  add(both.matrix, inertia, both.equations.mass());
  const Eigen::Index size = both.u.size();
  std::vector<Eight> X(static_cast<std::size_t>(size)), Y(X.size());
  std::vector<Vector> x;
  for (unsigned j = 0; j < 8; ++j) {
    x.push_back(random_vector(size, j));
    for (std::size_t k = 0; k < X.size(); ++k) X[k][j] = x[j][static_cast<Eigen::Index>(k)];
  }
  both.products().multiply(X, Y);
  for (std::size_t j = 0; j < 8; ++j) {
    Vector expected, y;
    multiply(both.matrix, x[j], expected);
    both.products().multiply(x[j], y);
    EXPECT_LT((y - expected).norm(), 1e-14 * expected.norm());
    for (std::size_t k = 0; k < X.size(); ++k) y[static_cast<Eigen::Index>(k)] = Y[k][j];
    EXPECT_LT((y - expected).norm(), 1e-14 * expected.norm());
  }
  EXPECT_LT(difference(both.matrix, both.products().matrix()), 1e-15);
}

/// Quadratic tetrahedra with one rotation each, or one at each point.
Model halves(Formulation formulation) {
  Model model = two_halves(CellKind::tet10);
  model.formulation = formulation;
  return model;
}

/// The same with mid nodes that lie off the middles of their edges by some tens of times `off`.
Model curved(Formulation formulation, double off) {
  Model model = halves(formulation);
  Mesh mesh = *model.mesh;
  for (int cell = 0; cell < mesh.cell_count(); ++cell)
    for (int a = 4; a < 10; ++a) mesh.points(mesh.cell(cell)[a], 2) += off * (1 + a);
  model.mesh = std::make_shared<const Mesh>(mesh);
  return model;
}

class KeptTangent : public ::testing::TestWithParam<Formulation> {};
INSTANTIATE_TEST_SUITE_P(All, KeptTangent, ::testing::Values(Formulation::standard, Formulation::single_rotation),
                         [](const auto& of) { return of.param == Formulation::standard ? "tet10" : "tet10SR"; });

TEST_P(KeptTangent, ComesWithTheForcesOfTheMatrix) {
  const Both both(halves(GetParam()));
  ASSERT_NE(both.equations.elements().kept_tangent(), nullptr);
  EXPECT_LT((both.kept_force - both.force).norm(), 1e-14 * both.force.norm());
  EXPECT_NEAR(both.kept_found.energy, both.found.energy, 1e-13 * both.found.energy);
  EXPECT_EQ(both.kept_found.smallest_J_element, both.found.smallest_J_element);
}

TEST_P(KeptTangent, MultipliesAsTheMatrixDoes) {
  Both both(halves(GetParam()));
  expect_products(both);
}

TEST_P(KeptTangent, DoesNotDependOnTheNumberOfThreads) {
  const auto product = [](int threads) {
    Vector y;
    tbb::task_arena(threads).execute([&] {
      Both both(halves(GetParam()));
      both.products().multiply(random_vector(both.u.size(), 1), y);
    });
    return y;
  };
  EXPECT_EQ(product(1), product(2));
}

// Elements with one rotation turn the stiffness at rest where edges are curved, however little.
TEST(SingleRotation, KeepsTheStiffnessAtRestTurned) {
  const Both both(halves(Formulation::single_rotation));
  Equations equations(curved(Formulation::single_rotation, 1e-12));
  Vector force = Vector::Zero(both.u.size());
  BlockMatrix turned(equations.elements().pattern());
  equations.elements().add_internal(both.u, Want::single_tangent, force, &turned);
  ASSERT_EQ(equations.elements().kept_tangent(), nullptr);
  EXPECT_LT(difference(turned, both.matrix), 1e-8);
}

// With a rotation at each point they keep those of curved elements too.
TEST(CurvedElements, KeepTheirTangents) {
  Both both(curved(Formulation::standard, 1e-4));
  expect_products(both);
}

// In a time step the stiffness is what relaxation leaves of it, here in one half.
TEST(RelaxingElements, KeepWhatIsLeft) {
  Model model = two_halves(CellKind::tet10);
  model.regions[1].prony = {.g = {0.6}, .tau = {0.1}};
  Both both(model, 0.05);
  const Both elastic(two_halves(CellKind::tet10));
  EXPECT_GT(difference(both.matrix, elastic.matrix), 1e-3);
  expect_products(both);
  model.formulation = Formulation::standard;
  EXPECT_EQ(Equations(model).elements().kept_tangent(), nullptr);
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
          const GradientProduct& product = gradient_products[static_cast<std::size_t>(16 * a + b)];
          double sum = product.first * G(a, i) * G(b, j);
          for (std::size_t n = 0; n < static_cast<std::size_t>(product.count); ++n)
            sum += product.second * G(product.pairs[n][0], i) * G(product.pairs[n][1], j);
          EXPECT_NEAR(sum, mean, 1e-14) << a << " " << b;
        }
}

/// A matrix that says how often its numbers were asked for.
struct Counted final : Products {
  explicit Counted(const BlockMatrix& of) : A(of) {}
  void multiply(const Vector& x, Vector& y) const override { fe::multiply(A, x, y); }
  void multiply(const std::vector<Eight>& /*X*/, std::vector<Eight>& /*Y*/) const override {}  // nothing is expected
  const BlockMatrix& matrix() const override { return ++asked, A; }

  const BlockMatrix& A;
  mutable int asked = 0;
};

/// A multigrid solver with a matrix, another matrix on the same pattern, and what solutions leave.
struct Solver {
  explicit Solver(const Model& model)
      : both(model),
        fixed(make_supports(model.steps[0], both.equations.numbering(), both.u).fixed),
        system(make_multigrid(both.equations.geometry())),
        right(random_vector(both.u.size(), 3)) {
    add(both.matrix, inertia, both.equations.mass());
  }
  /// |b - A x| / |b| at free unknowns.
  double left(const BlockMatrix& A) {
    Vector x, product;
    EXPECT_EQ(system->solve(right, 1e-9, x), LinearStatus::done);
    multiply(A, x, product);
    return free_norm(right - product, fixed) / free_norm(right, fixed);
  }

  Both both;
  Mask fixed;
  std::unique_ptr<LinearSystem> system;
  Vector right;
};

TEST(Multigrid, TakesProductsOnceItHasGrids) {
  Solver solver(two_halves(CellKind::tet10));
  const Counted products(solver.both.matrix);
  EXPECT_FALSE(solver.system->take(products, solver.fixed));
  ASSERT_EQ(solver.system->factor(solver.both.matrix, solver.fixed), LinearStatus::done);
  EXPECT_LT(solver.left(solver.both.matrix), 1e-9);
  ASSERT_TRUE(solver.system->take(products, solver.fixed));
  EXPECT_LT(solver.left(solver.both.matrix), 1e-9);
  EXPECT_EQ(products.asked, 0);
  Mask freed = solver.fixed;
  freed[static_cast<std::size_t>(std::ranges::find(freed, 1) - freed.begin())] = 0;
  EXPECT_FALSE(solver.system->take(products, freed));
}

// The grids of one half being soft are of no use where the other one is.
TEST(Multigrid, AsksProductsForNumbersWhereItsGridsDoNotServe) {
  Model other = two_halves(CellKind::tet10);
  std::swap(other.regions[0].elements, other.regions[1].elements);
  for (Region& region : other.regions)
    if (region.name == "soft")
      region.law = make_linear_elastic({.youngs_modulus = 20, .poisson_ratio = 0.3, .strain = Strain::corotated});
  Solver solver(two_halves(CellKind::tet10)), changed(other);
  ASSERT_EQ(solver.system->factor(solver.both.matrix, solver.fixed), LinearStatus::done);
  EXPECT_LT(solver.left(solver.both.matrix), 1e-9);
  ASSERT_EQ(*changed.both.matrix.pattern->columns.data(), *solver.both.matrix.pattern->columns.data());
  const Counted products(changed.both.matrix);
  ASSERT_TRUE(solver.system->take(products, solver.fixed));
  EXPECT_LT(solver.left(changed.both.matrix), 1e-9);
  EXPECT_EQ(products.asked, 1);
}

/// Thirty steps under gravity, one linear solve each; the end at x = 0 is pulled along x.
Model falling_beam(Formulation formulation, LinearSolver solver) {
  Model model = halves(formulation);
  model.settings.integrator = Integrator::implicit_euler;
  model.settings.newton_iterations = 1;
  model.settings.linear_tolerance = 1e-10;
  model.settings.linear_solver = solver;
  model.steps[0].dt = 1.0 / 30;
  model.steps[0].count = 30;
  model.steps[0].prescribed[0].values = {Vec3(0.01, 0, 0)};
  model.steps[0].prescribed[0].ramp = Ramp::linear;
  return model;
}

TEST_P(KeptTangent, TakesTimeStepsAsAMatrixDoes) {
  const auto run = [](LinearSolver solver) {
    return solve(falling_beam(GetParam(), solver), [](const State&) { return true; });
  };
  const Outcome plain = run(LinearSolver::direct), fast = run(LinearSolver::cg);
  ASSERT_EQ(plain.stop, Stop::converged);
  ASSERT_EQ(fast.stop, Stop::converged);
  EXPECT_GT(fast.cg_iterations, 30);
  EXPECT_FALSE(fast.cg_gave_up);
  const Points &expected = plain.state.displacement, &u = fast.state.displacement;
  EXPECT_GT(expected.norm(), 0.01);
  EXPECT_LT((u - expected).norm(), 1e-7 * expected.norm());
}

}  // namespace
}  // namespace msml::fe::testing
