// SPDX-License-Identifier: GPL-3.0-or-later
// Multigrid: the same answers as a factorisation, in as many iterations on fine meshes as on coarse ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "solver/equations.hpp"
#include "solver/linear/multigrid/multigrid.hpp"
#include "solver/newton.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

Model solved_by(Model model, LinearSolver solver, double tolerance) {
  model.settings.linear_solver = solver;
  model.settings.preconditioner = Preconditioner::multigrid;
  model.settings.linear_tolerance = tolerance;
  return model;
}

Outcome run(const Model& model) {
  Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_FALSE(outcome.cg_gave_up);
  return outcome;
}

/// Largest difference of displacements beside the largest displacement.
double difference(const State& a, const State& b) {
  return (a.displacement - b.displacement).cwiseAbs().maxCoeff() / a.displacement.cwiseAbs().maxCoeff();
}

// The error may be larger than the residual by the condition number of the beam, about 1e5 here, and rarely is. Near
// incompressibility the matrix is ten times as large and so is the round-off in a residual: the tolerance leaves room.
TEST(Multigrid, AgreesWithAFactorisation) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10})
    for (const double poisson_ratio : {0.3, 0.49}) {
      const double tolerance = poisson_ratio > 0.4 ? 1e-9 : 1e-10;
      const Model model = beam_model(3, kind, poisson_ratio, Strain::small);
      EXPECT_LT(difference(run(solved_by(model, LinearSolver::direct, 1e-12)).state,
                           run(solved_by(model, LinearSolver::cg, tolerance)).state),
                100 * tolerance);
    }
}

// With a smoother alone the iterations double where the elements halve, and where the volume is hardly allowed to
// change they grow with the root of lambda / mu: to five times those of nu = 0.3.
TEST(Multigrid, NeedsAtMostFortyIterationsOnAnyMeshUpToNearIncompressibility) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10})
    for (const double poisson_ratio : {0.3, 0.45, 0.49})
      for (const int n : {kind == CellKind::tet4 ? 6 : 4, kind == CellKind::tet4 ? 10 : 6})
        EXPECT_LE(
            run(solved_by(beam_model(n, kind, poisson_ratio, Strain::small), LinearSolver::cg, 1e-8)).cg_iterations, 40)
            << (kind == CellKind::tet4 ? "tet4" : "tet10") << ", n = " << n << ", nu = " << poisson_ratio;
}

TEST(Multigrid, IterationsDoNotGrowWithTheMesh) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    std::vector<long> iterations;
    for (const int n : {3, 6})
      iterations.push_back(
          run(solved_by(beam_model(n, kind, 0.3, Strain::small), LinearSolver::cg, 1e-8)).cg_iterations);
    EXPECT_LE(iterations[1], iterations[0] + 6);
  }
}

// Displacements and supports in single directions: the grids must leave held unknowns alone.
TEST(Multigrid, HoldsSingleComponents) {
  for (const double poisson_ratio : {0.3, 0.49}) {
    Model model = beam_model(3, CellKind::tet10, poisson_ratio, Strain::small);
    model.steps[0].prescribed = {
        fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }), true, false, true),
        fix(points_where(*model.mesh, [](const Vec3& x) { return x[1] < 1e-9; }), false, true, false)};
    EXPECT_LT(difference(run(solved_by(model, LinearSolver::direct, 1e-12)).state,
                         run(solved_by(model, LinearSolver::cg, 1e-10)).state),
              1e-8)
        << poisson_ratio;
  }
}

Model swinging(int steps, CellKind kind, double poisson_ratio) {
  Model model = beam_model(2, kind, poisson_ratio, Strain::corotated);
  model.settings.integrator = Integrator::implicit_euler;
  model.settings.newton_iterations = 1;
  model.steps[0].dt = 1.0 / 30;
  model.steps[0].count = steps;
  return model;
}

// The grids of the first step serve them all: the cycle turns with the beam, which swings by more than 60 degrees.
TEST(Multigrid, FollowsABodyThatTurns) {
  const auto follow = [](CellKind kind, double poisson_ratio, long iterations) {
    const Model model = swinging(20, kind, poisson_ratio);
    const Outcome iterated = run(solved_by(model, LinearSolver::cg, 1e-9));
    EXPECT_LT(difference(run(solved_by(model, LinearSolver::direct, 1e-12)).state, iterated.state), 1e-6);
    EXPECT_LT(iterated.cg_iterations, 20 * iterations);
  };
  follow(CellKind::tet4, 0.3, 30);
  follow(CellKind::tet10, 0.49, 60);
}

TEST(Multigrid, DoesNotDependOnTheNumberOfThreads) {
  for (const double poisson_ratio : {0.3, 0.49}) {
    Model model = solved_by(beam_model(4, CellKind::tet10, poisson_ratio, Strain::small), LinearSolver::cg, 1e-8);
    const Outcome one = run(model);
    model.settings.threads = 2;
    EXPECT_EQ((one.state.displacement - run(model).state.displacement).cwiseAbs().maxCoeff(), 0);
  }
}

// Pulled at both ends and held nowhere: the strain is that of a factorisation, whatever rigid motion is added.
TEST(Multigrid, SolvesAFreeBodyUnderBalancedLoads) {
  Model model = beam_model(3, CellKind::tet10, 0.3, Strain::small);
  model.steps[0].gravity = Vec3::Zero();
  model.steps[0].prescribed.clear();
  const auto end = [&](double x) {
    return points_where(*model.mesh, [=](const Vec3& X) { return std::abs(X[0] - x) < 1e-9; });
  };
  model.steps[0].forces = {{.name = "left", .nodes = end(0), .values = {Vec3(-1e-3, 0, 0)}},
                           {.name = "right", .nodes = end(0.1), .values = {Vec3(1e-3, 0, 0)}}};
  const Outcome direct = run(solved_by(model, LinearSolver::direct, 1e-10));
  const Outcome iterated = run(solved_by(model, LinearSolver::cg, 1e-10));
  EXPECT_NEAR(iterated.state.energies.elastic, direct.state.energies.elastic, 1e-8 * direct.state.energies.elastic);
}

std::vector<float> some_numbers(int count, const Mask& fixed) {
  std::vector<float> values(static_cast<std::size_t>(count) + 8, 0.0f);
  for (int k = 0; k < count; ++k)
    if (!fixed[static_cast<std::size_t>(k)])
      values[static_cast<std::size_t>(k)] = static_cast<float>(std::sin(1.0 + 12.9898 * k));
  return values;
}

// P^T is the transpose of P, and a function that is linear in X is met exactly at mid nodes.
TEST(Multigrid, CornersCarryLinearFunctionsToMidNodes) {
  const Model model = beam_model(2, CellKind::tet10, 0.3, Strain::small);
  const Equations equations(model);
  const NodeGeometry geometry = equations.geometry();
  const Mask fixed(static_cast<std::size_t>(equations.size()), 0);
  const Corners corners(geometry, fixed);
  std::vector<float> linear(3 * static_cast<std::size_t>(corners.count()) + 8, 0.0f);
  for (int c = 0; c < corners.count(); ++c)
    for (int i = 0; i < 3; ++i)
      linear[static_cast<std::size_t>(3 * c + i)] =
          static_cast<float>(geometry.positions[3 * corners.node_of()[static_cast<std::size_t>(c)] + (i + 1) % 3]);
  std::vector<float> fine(fixed.size() + 8, 0.0f);
  corners.add_prolonged(linear, fine);
  for (int k = 0; k < equations.size(); ++k)
    EXPECT_NEAR(fine[static_cast<std::size_t>(k)], geometry.positions[k / 3 * 3 + (k % 3 + 1) % 3], 1e-8);

  const std::vector<float> f = some_numbers(equations.size(), fixed),
                           c = some_numbers(3 * corners.count(),
                                            Mask(3 * static_cast<std::size_t>(corners.count()), 0));
  std::vector<float> Pc(fixed.size() + 8, 0.0f), Pf(c.size(), 0.0f);
  corners.add_prolonged(c, Pc);
  corners.restrict_vector(f, Pf);
  double one = 0, other = 0, size = 0;
  for (std::size_t k = 0; k < fixed.size(); ++k) one += static_cast<double>(f[k]) * Pc[k], size += f[k] * f[k];
  for (std::size_t k = 0; k < c.size(); ++k) other += static_cast<double>(c[k]) * Pf[k];
  EXPECT_NEAR(one, other, 1e-5 * size);  // single precision
}

/// Iterations for the step matrix of a co-rotated beam that is turned as a whole by an angle.
long iterations_turned(double angle, LinearSystem& system, const Equations& equations) {
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Vector u(equations.size());
  for (Eigen::Index k = 0; k < u.size(); k += 3)
    u.segment<3>(k) = R * equations.positions().segment<3>(k) - equations.positions().segment<3>(k);
  BlockMatrix A(equations.elements().pattern());
  Forces forces;
  equations.evaluate(u, {}, Want::single_tangent, forces, &A);
  add(A, 900, equations.mass());
  system.place(u);
  EXPECT_EQ(system.factor(A, Mask(static_cast<std::size_t>(u.size()), 0)), LinearStatus::done);
  Vector right(u.size()), x;
  for (Eigen::Index k = 0; k < u.size(); k += 3) right.segment<3>(k) = R * Vec3(0, 0, std::sin(static_cast<double>(k)));
  const long before = system.iterations;
  EXPECT_EQ(system.solve(right, 1e-8, x), LinearStatus::done);
  return system.iterations - before;
}

// The matrix of the turned body is that of the body at rest in turned axes: its grids serve as well.
TEST(Multigrid, TurnsWithTheBody) {
  const Equations equations(beam_model(4, CellKind::tet4, 0.3, Strain::corotated));
  const auto system = make_multigrid(equations.geometry());
  const long at_rest = iterations_turned(0, *system, equations);
  EXPECT_NEAR(iterations_turned(1, *system, equations), at_rest, 1);
  EXPECT_NEAR(iterations_turned(2.5, *system, equations), at_rest, 1);
}

/// The stiffness of a beam at rest and its supports.
struct Stiffness {
  Stiffness(int n, CellKind kind, double poisson_ratio)
      : model(beam_model(n, kind, poisson_ratio, Strain::small)), equations(model), A(equations.elements().pattern()) {
    const Vector zero = Vector::Zero(equations.size());
    Forces forces;
    equations.evaluate(zero, {}, Want::tangent, forces, &A);
    fixed = make_supports(model.steps[0], equations.numbering(), zero).fixed;
  }
  Model model;
  Equations equations;
  BlockMatrix A;
  Mask fixed;
};

/// Norm of what round-off in A x may leave: eps |A| |x|.
double round_off(const Stiffness& beam, const Vector& x) {
  BlockMatrix size = beam.A;
  for (double& value : size.values) value = std::abs(value);
  Vector bound;
  multiply(size, x.cwiseAbs(), bound);
  return std::numeric_limits<double>::epsilon() * free_norm(bound, beam.fixed);
}

// Where round-off is all that is left, once more may win a digit; more often does not. Without that rule 37, 62 and 95.
TEST(Multigrid, DoesNotIterateOnRoundOff) {
  for (const auto& [poisson_ratio, most] : {std::pair{0.3, 34L}, {0.45, 57L}, {0.49, 85L}}) {
    const Stiffness beam(4, CellKind::tet10, poisson_ratio);
    const auto system = make_multigrid(beam.equations.geometry());
    ASSERT_EQ(system->factor(beam.A, beam.fixed), LinearStatus::done);
    Vector x, product, weight = Vector::Zero(beam.equations.size());
    for (Eigen::Index k = 2; k < weight.size(); k += 3) weight[k] = -1;
    EXPECT_EQ(system->solve(weight, 1e-8, x), LinearStatus::done);
    const long before = system->iterations;
    EXPECT_EQ(system->solve(weight, 1e-13, x), LinearStatus::done);
    EXPECT_LE(system->iterations - before, most) << poisson_ratio;
    multiply(beam.A, x, product);
    EXPECT_LE(free_norm(weight - product, beam.fixed), round_off(beam, x)) << poisson_ratio;
  }
}

// What is expected is scaled, serves the next solution alone, and does no harm where it is of no use.
TEST(ConjugateGradients, StartFromTheBestMultipleOfWhatIsExpected) {
  const Stiffness beam(4, CellKind::tet4, 0.3);
  const Vector b = Vector::LinSpaced(static_cast<Eigen::Index>(beam.fixed.size()), -1, 2);
  for (const auto& system :
       {make_multigrid(beam.equations.geometry()), make_conjugate_gradient(Preconditioner::jacobi)}) {
    ASSERT_EQ(system->factor(beam.A, beam.fixed), LinearStatus::done);
    const auto iterations = [&](const Vector& right, Vector& x) {
      const long before = system->iterations;
      EXPECT_EQ(system->solve(right, 1e-6, x), LinearStatus::done);
      return system->iterations - before;
    };
    Vector x, again, other;
    const long cold = iterations(b, x);
    system->expect(-7 * x);
    EXPECT_EQ(iterations(b, again), 0);
    EXPECT_LT((again - x).norm(), 1e-12 * x.norm());
    EXPECT_EQ(iterations(b, again), cold);
    EXPECT_EQ(again, x);
    system->expect(b);  // held unknowns are not to be moved
    EXPECT_LE(iterations(b, other),
              1.1 * static_cast<double>(cold) + 1);  // nearer in energy, but what is left is rougher
    EXPECT_LT((other - x).norm(), 1e-4 * x.norm());
    system->expect(Vector::Zero(b.size()));  // the solution that was kept serves
    EXPECT_EQ(iterations(b, again), 0);
  }
}

double inner(const std::vector<float>& a, const std::vector<float>& b, std::size_t count) {
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(a[k]) * b[k];
  return sum;
}

// Conjugate gradients want a symmetric preconditioner: a V b = b V a, to single precision.
TEST(Multigrid, HasASymmetricCycle) {
  for (const double poisson_ratio : {0.3, 0.49})
    for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
      const Stiffness beam(kind == CellKind::tet4 ? 9 : 4, kind, poisson_ratio);
      Multigrid grids(beam.equations.geometry());
      ASSERT_EQ(grids.set(beam.A, beam.fixed), LinearStatus::done);
      const std::size_t count = beam.fixed.size();
      std::vector<float> a = some_numbers(static_cast<int>(count), beam.fixed), b = a, Va(a.size()), Vb(a.size());
      for (std::size_t k = 0; k < count; ++k) b[k] *= static_cast<float>(std::cos(0.1 * static_cast<double>(k)));
      grids.cycle(a, Va);
      grids.cycle(b, Vb);
      EXPECT_NEAR(inner(a, Vb, count), inner(b, Va, count),
                  1e-4 * std::sqrt(inner(a, Va, count) * inner(b, Vb, count)));
    }
}

// The second set-up keeps the grids. All steps are linear in the matrix: half the solution of the same residual.
TEST(Multigrid, IsSetUpAgainForAnotherMatrix) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Stiffness beam(kind == CellKind::tet4 ? 9 : 6, kind, kind == CellKind::tet4 ? 0.3 : 0.49);
    const Mask& fixed = beam.fixed;
    BlockMatrix& A = beam.A;
    Multigrid grids(beam.equations.geometry());
    std::vector<float> r(fixed.size() + 8, 1.0f), once(r.size()), again(r.size());
    for (std::size_t k = 0; k < fixed.size(); ++k)
      if (fixed[k]) r[k] = 0;
    ASSERT_EQ(grids.set(A, fixed), LinearStatus::done);
    grids.cycle(r, once);
    for (double& value : A.values) value *= 2;
    ASSERT_EQ(grids.set(A, fixed), LinearStatus::done);
    grids.cycle(r, again);
    float largest = 0, off = 0;
    for (std::size_t k = 0; k < fixed.size(); ++k) {
      largest = std::max(largest, std::abs(once[k]));
      off = std::max(off, std::abs(once[k] - 2 * again[k]));
    }
    EXPECT_LT(off, 1e-3f * largest);  // single precision
  }
}

/// A beam that falls under its weight, one solution by conjugate gradients a step.
Model falling_beam(int n, int count) {
  Model model = beam_model(n, CellKind::tet4, 0.3, Strain::corotated);
  model.steps[0].dt = 1.0 / 30, model.steps[0].count = count;
  model.settings.integrator = Integrator::implicit_euler;
  model.settings.newton_iterations = 1;
  model.settings.linear_tolerance = 1e-6;
  model.settings.linear_solver = LinearSolver::cg;
  model.settings.preconditioner = Preconditioner::multigrid;
  return model;
}

// Backward Euler has damped everything by then: what is left of the forces is round-off.
TEST(Multigrid, HasNothingToDoForABodyAtRest) {
  EXPECT_LT(run(falling_beam(4, 350)).cg_iterations - run(falling_beam(4, 300)).cg_iterations, 50);
}

// A load from rest that moves a steel beam by less than round-off in its coordinates is no round-off of forces.
TEST(Multigrid, SolvesForLoadsThatAreTinyBesideTheStiffness) {
  Model model = falling_beam(4, 1);
  model.regions[0].law =
      make_linear_elastic({.youngs_modulus = 2e11, .poisson_ratio = 0.3, .strain = Strain::corotated});
  model.steps[0].gravity *= 1e-7;
  const State iterated = run(model).state;
  model.settings.linear_solver = LinearSolver::direct;
  EXPECT_LT(difference(run(model).state, iterated), 1e-4);
}

// Starting vectors, sums by rows, halves and shared loops of time steps, on a mesh of several pieces.
TEST(Multigrid, TakesTimeStepsThatDoNotDependOnTheNumberOfThreads) {
  Model model = falling_beam(9, 12);
  const State one = run(model).state;
  model.settings.threads = 2;
  const State two = run(model).state;
  EXPECT_EQ((one.displacement - two.displacement).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ((one.velocity - two.velocity).cwiseAbs().maxCoeff(), 0);
}

// A beam pressed past its buckling load: straight, it is in equilibrium, which is not stable.
TEST(Multigrid, SeesThatAnEquilibriumIsUnstable) {
  Model model = beam_model(2, CellKind::tet4, 0.3, Strain::corotated);
  model.steps[0].gravity = Vec3::Zero();
  const auto ends = points_where(*model.mesh, [](const Vec3& x) { return x[0] > 0.1 - 1e-9; });
  model.steps[0].prescribed.push_back(fix(ends, true, true, true));
  model.steps[0].prescribed.back().values = {Vec3(-0.02, 0, 0)};
  model.settings.load_steps = 4;
  const Outcome direct = solve(solved_by(model, LinearSolver::direct, 1e-10), {});
  const Outcome iterated = solve(solved_by(model, LinearSolver::cg, 1e-10), {});
  EXPECT_EQ(direct.stop, Stop::indefinite_tangent);
  EXPECT_EQ(iterated.stop, direct.stop) << direct.diagnosis << "\n" << iterated.diagnosis;
}

}  // namespace
}  // namespace msml::fe
