// SPDX-License-Identifier: GPL-3.0-or-later
// Static answers: closed forms, linear solvers against each other, threads, steps.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

bool at_bottom(const Vec3& x) { return x[2] < 1e-9; }

Model column(CellKind kind, Strain strain, double density = 2) {
  Model model = make_model(box_mesh(2, 2, 6, {1, 1, 4}, kind),
                           {.youngs_modulus = 1e5, .poisson_ratio = 0, .strain = strain}, density);
  model.steps[0].gravity = Vec3(0, 0, -10);
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom))};
  return model;
}

// rho g L^2 / (2 E). Under a uniform end load the exact displacement is linear, hence in the finite element space; by
// the reciprocal theorem the mean displacement of the top under gravity is then exact.
TEST(Column, SinksUnderItsOwnWeightByTheClosedFormInTheMean) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = column(kind, Strain::small);
    FaceLoad unit{.name = "unit", .tractions = {Vec3(0, 0, 1)}};
    unit.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[2] > 4 - 1e-9; });
    Model other = model;
    other.steps[0].gravity.setZero();
    other.steps[0].face_loads = {unit};
    const Outcome pulled = solve(other, {}), hanging = solve(model, {});
    EXPECT_NEAR(pulled.state.displacement(nearest_point(*model.mesh, {0, 0, 4}), 2), 4e-5, 1e-14);
    // Mean over the top, weighted as the unit traction is shared among the nodes: its work on the displacement.
    const Outcome both = [&] {
      Model sum = model;
      sum.steps[0].face_loads = {unit};
      return solve(sum, {});
    }();
    EXPECT_LT((both.state.displacement - pulled.state.displacement - hanging.state.displacement).norm(), 1e-12);
    double mean = 0, area = 0;
    for (const Face& face : unit.faces)
      for (int a = 0; a < 3; ++a) {
        const auto& local = tet_faces[static_cast<std::size_t>(face.local)];
        const int corner = model.mesh->cell(face.element)[local[static_cast<std::size_t>(a)]];
        const int mid =
            kind == CellKind::tet10 ? model.mesh->cell(face.element)[local[static_cast<std::size_t>(a + 3)]] : corner;
        mean += hanging.state.displacement(mid, 2);
        area += 1;
      }
    // A quadratic triangle's mean is the mean of its mid nodes; all triangles are equally large.
    EXPECT_NEAR(mean / area, -2 * 10 * 16 / (2 * 1e5), 1e-12);
    EXPECT_NEAR(hanging.check.sum_loads[2], -2 * 10 * 4, 1e-9);
    EXPECT_NEAR(hanging.check.sum_reactions[2], 2 * 10 * 4, 1e-9);
    EXPECT_NEAR(hanging.check.mass, 8, 1e-12);
    EXPECT_NEAR(hanging.check.volume, 4, 1e-12);
  }
}

Model hard_beam() {
  Model model = beam_model(2, CellKind::tet10, 0.3, Strain::corotated);
  model.settings.load_steps = 2;
  return model;
}

TEST(LinearSolvers, AgreeToTheirTolerance) {
  Model model = beam_model(2, CellKind::tet10, 0.3, Strain::small);
  model.settings.linear_solver = LinearSolver::direct;
  const Points direct = solve(model, {}).state.displacement;
  model.settings.linear_solver = LinearSolver::cg;
  long none = 0;
  for (const Preconditioner p : {Preconditioner::none, Preconditioner::jacobi, Preconditioner::block_jacobi,
                                 Preconditioner::incomplete_cholesky, Preconditioner::automatic}) {
    model.settings.preconditioner = p;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_LT((outcome.state.displacement - direct).norm(), 1e-8 * direct.norm());
    EXPECT_GT(outcome.cg_iterations, 10);
    if (p == Preconditioner::none) none = outcome.cg_iterations;
    if (p == Preconditioner::incomplete_cholesky) {
      EXPECT_LT(outcome.cg_iterations, none / 2);
    }
  }
}

TEST(Threads, DoNotChangeASingleBit) {
  const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 4);  // also where there are fewer cores
  Model model = hard_beam();
  model.settings.linear_solver = LinearSolver::cg;
  const Outcome one = solve(model, {});
  model.settings.threads = 3;
  const Outcome three = solve(model, {});
  ASSERT_EQ(one.stop, Stop::converged) << one.diagnosis;
  EXPECT_EQ(one.state.displacement, three.state.displacement);
  EXPECT_EQ(one.state.reaction, three.state.reaction);
  EXPECT_EQ(one.cg_iterations, three.cg_iterations);
}

TEST(Static, ReachesTheSameStateInOneOrManyLoadSteps) {
  Model model = hard_beam();
  const Outcome two = solve(model, {});
  model.settings.load_steps = 7;
  int states = 0;
  const Outcome seven = solve(model, [&](const State& state) { return state.increment == states++; });
  EXPECT_EQ(states, 8);
  EXPECT_EQ(seven.stop, Stop::converged) << seven.diagnosis;
  EXPECT_LT((two.state.displacement - seven.state.displacement).norm(), 1e-6 * two.state.displacement.norm());
}

TEST(Static, ConvergesQuadraticallyWithTheExactTangent) {
  Model model = beam_model(2, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.tolerance = 1e-10;
  const Outcome exact = solve(model, {});
  ASSERT_EQ(exact.stop, Stop::converged) << exact.diagnosis;
  EXPECT_LE(exact.newton_iterations, 9);
  Model rotated = model;
  rotated.regions[0].law =
      make_linear_elastic({.youngs_modulus = 1e5, .poisson_ratio = 0.3, .tangent = TangentKind::rotated});
  rotated.settings.newton_iterations = 200;
  const Outcome slow = solve(rotated, {});
  ASSERT_EQ(slow.stop, Stop::converged) << slow.diagnosis;
  EXPECT_GT(slow.newton_iterations, exact.newton_iterations);
  EXPECT_LT((slow.state.displacement - exact.state.displacement).norm(), 1e-7 * exact.state.displacement.norm());
}

TEST(Static, HoldsLoadsOfTheStepBeforeWhenTheNextOneAsksForTheSame) {
  Model model = hard_beam();
  const Outcome once = solve(model, {});
  model.steps.push_back(model.steps[0]);
  const Outcome twice = solve(model, {});
  EXPECT_EQ(twice.state.increment, 4);
  EXPECT_DOUBLE_EQ(twice.state.time, 2);
  EXPECT_LT((once.state.displacement - twice.state.displacement).norm(), 1e-6 * once.state.displacement.norm());
}

TEST(Static, TurnsABeamsEndByNinetyDegrees) {
  Model model = make_model(box_mesh(2, 2, 8, {1, 1, 5}, CellKind::tet10), {.youngs_modulus = 1000});
  const std::vector<int> top = points_where(*model.mesh, [](const Vec3& x) { return x[2] > 5 - 1e-9; });
  Prescribed turn{.name = "turn", .nodes = top};
  for (const int n : top) {
    const double x = model.mesh->points(n, 0) - 0.5, y = model.mesh->points(n, 1) - 0.5;
    turn.values.push_back(Vec3(-y - x, x - y, 0));
  }
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom)), turn};
  model.settings.load_steps = 3;
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  // Half way up the section has turned by 45 degrees.
  const Vec3 u = outcome.state.displacement.row(nearest_point(*model.mesh, {1, 0.5, 2.5})).transpose();
  EXPECT_NEAR(std::atan2(0.5 * 0 + u[1], 0.5 + u[0]) * 180 / M_PI, 45, 1);
  EXPECT_GT(outcome.check.smallest_J, 0.5);
}

// A hanging or standing column with nu = 0: the displacement of the end is rho g L^2/(2E), and quadratic along it.
TEST(Static, AColumnUnderItsOwnWeightIsShortenedByTheClosedForm) {
  const double E = 1e4, L = 4, rho = 2, g = 9.81;
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = make_model(box_mesh(1, 1, 8, {1, 1, L}, kind),
                             {.youngs_modulus = E, .poisson_ratio = 0, .strain = Strain::small}, rho);
    model.steps[0].gravity = Vec3(0, 0, -g);
    model.steps[0].prescribed = {
        fix(points_where(*model.mesh, [](const Vec3& x) { return x[2] < 1e-9; }), true, true, true)};
    const Outcome outcome = solve(model, {});
    double mean = 0;
    const std::vector<int> top = points_where(*model.mesh, [=](const Vec3& x) { return x[2] > L - 1e-9; });
    for (const int n : top) mean += outcome.state.displacement(n, 2) / static_cast<double>(top.size());
    // The loads of linear elements are lumped to nodes unevenly: their mean is off by the square of the element size.
    const double exact = -rho * g * L * L / (2 * E);
    EXPECT_NEAR(mean, exact, (kind == CellKind::tet4 ? 0.02 : 1e-3) * std::abs(exact));
    EXPECT_NEAR(outcome.check.sum_reactions[2], rho * g * L, 1e-9 * rho * g * L);
  }
}

TEST(Statics, AnAnswerOutOfBalanceIsWarnedOf) {
  Model model = beam_model(2, CellKind::tet4, 0.3, Strain::corotated);
  const auto warned = [](const Outcome& outcome) {
    return std::any_of(outcome.warnings.begin(), outcome.warnings.end(),
                       [](const std::string& text) { return text.find("out of balance") != std::string::npos; });
  };
  EXPECT_FALSE(warned(solve(model, {})));
  model.settings.newton_iterations = 1;
  EXPECT_TRUE(warned(solve(model, {})));
}

// Pulled at both ends: loads, reactions and inertia all sum to nothing.
TEST(Statics, ABodyInBalanceWithItselfIsInBalance) {
  Model model =
      make_model(box_mesh(2, 2, 2, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1000, .poisson_ratio = 0.3});
  const auto at = [&](double x) {
    return points_where(*model.mesh, [x](const Vec3& X) { return std::abs(X[0] - x) < 1e-9; });
  };
  Prescribed pulled = fix(at(1), true, false, false);
  pulled.values = {Vec3(0.1, 0, 0)};
  model.steps[0].prescribed = {fix(at(0)), pulled};
  const Outcome outcome = solve(model, {});
  ASSERT_EQ(outcome.stop, Stop::converged);
  EXPECT_LT(outcome.check.balance, 1e-6);
}

}  // namespace
}  // namespace msml::fe
