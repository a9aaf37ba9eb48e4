// SPDX-License-Identifier: GPL-3.0-or-later
// How runs fail: every reason is reached, named and explained; the last good state is kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/equations.hpp"
#include "solver/linear/linear_system.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

bool at_bottom(const Vec3& x) { return x[2] < 1e-9; }
bool at_top(const Vec3& x) { return x[2] > 1 - 1e-9; }

/// A unit cube whose top is moved by dz.
Model squeezed(double dz, Ramp ramp = Ramp::linear) {
  Model model = make_model(box_mesh(2, 2, 2, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1000});
  Prescribed top{.name = "top", .nodes = points_where(*model.mesh, at_top), .values = {Vec3(0, 0, dz)}, .ramp = ramp};
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom)), top};
  return model;
}

TEST(Failure, AnInvertedElementIsNamedWithItsPlace) {
  Model model = squeezed(-1.5);
  model.settings.load_steps = 6;
  int states = 0;
  const Outcome outcome = solve(model, [&](const State&) { return ++states > 0; });
  EXPECT_EQ(outcome.stop, Stop::inverted_element) << name(outcome.stop);
  EXPECT_THAT(outcome.diagnosis, HasSubstr("step 1 'load' stopped at"));
  EXPECT_THAT(outcome.diagnosis, HasSubstr("inverted element"));
  EXPECT_THAT(outcome.diagnosis, HasSubstr("worst element "));
  EXPECT_THAT(outcome.diagnosis, HasSubstr("det F = -"));
  EXPECT_GT(outcome.check.smallest_J, 0);  // the last good state
  EXPECT_GE(states, 4);
}

// Euler: a clamped-free column buckles at pi^2 E I / (4 L^2); a straight one stays straight and becomes unstable.
TEST(Failure, AColumnBeyondEulersLoadHasAnIndefiniteTangent) {
  const double E = 1000, L = 8, I = 1.0 / 12, euler = M_PI * M_PI * E * I / (4 * L * L);
  for (const double share : {0.85, 1.2}) {
    Model model = make_model(box_mesh(1, 1, 8, {1, 1, L}, CellKind::tet10), {.youngs_modulus = E, .poisson_ratio = 0});
    model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom))};
    FaceLoad load{.name = "top", .pressures = {share * euler}};
    load.faces = faces_where(*model.mesh, [&](const Vec3& x) { return x[2] > L - 1e-9; });
    model.steps[0].face_loads = {load};
    model.settings.load_steps = 2;
    const Outcome outcome = solve(model, {});
    if (share < 1) {
      EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    } else {
      EXPECT_EQ(outcome.stop, Stop::indefinite_tangent) << outcome.diagnosis;
      EXPECT_THAT(outcome.diagnosis, HasSubstr("unstable"));
    }
  }
}

TEST(Failure, TheIterationLimitIsNamedWithTheResiduals) {
  Model model = beam_model(1, CellKind::tet10, 0.3, Strain::corotated);
  model.settings.newton_iterations = 2;
  model.settings.tolerance = 1e-12;
  model.steps[0].gravity *= 100;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::newton_limit) << outcome.diagnosis;
  EXPECT_THAT(outcome.diagnosis, HasSubstr("residuals "));
  EXPECT_THAT(outcome.diagnosis, HasSubstr("more loadSteps"));
}

TEST(Failure, AnOverflowIsADivergence) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::corotated);
  model.steps[0].gravity *= 1e250;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::diverged) << outcome.diagnosis;
  EXPECT_TRUE(outcome.state.displacement.allFinite());
}

// 1e-30 is below round-off: conjugate gradients can only miss it, and the direct solver takes over. (Multigrid accepts
// what round-off leaves.)
TEST(Failure, ConjugateGradientsThatMissTheirToleranceGiveWayToCholesky) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::small);
  model.settings.linear_solver = LinearSolver::cg;
  model.settings.preconditioner = Preconditioner::block_jacobi;
  model.settings.linear_tolerance = 1e-30;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_TRUE(outcome.cg_gave_up);
  EXPECT_LT(outcome.check.residual, 1e-10);
}

// A free body in time steps so long that its inertia is a millionth of its stiffness: single precision loses the one
// beside the other, and multigrid is no longer positive definite, but the matrix is.
TEST(Failure, MultigridThatRoundsInertiaAwayGivesWayToCholesky) {
  const Model model = beam_model(4, CellKind::tet4, 0.3, Strain::small);
  const Equations equations(model);
  const Mask nothing(static_cast<std::size_t>(equations.size()), 0);
  BlockMatrix A(equations.elements().pattern());
  Vector b = Vector::Zero(equations.size()), x, Ax;
  equations.elements().add_internal(Vector::Zero(equations.size()), Want::tangent, b, &A);
  add(A, 1e-3, equations.mass());
  multiply(A, Vector::Ones(equations.size()) + 10 * equations.positions(), b);  // moves and stretches
  const auto multigrid = make_multigrid(equations.geometry());
  ASSERT_EQ(multigrid->factor(A, nothing), LinearStatus::done);
  EXPECT_EQ(multigrid->solve(b, 1e-10, x), LinearStatus::limit);
  const auto automatic = make_linear_system(model.settings, equations.geometry());
  ASSERT_EQ(automatic->factor(A, nothing), LinearStatus::done);
  ASSERT_EQ(automatic->solve(b, 1e-10, x), LinearStatus::done);
  EXPECT_TRUE(automatic->gave_up);
  multiply(A, x, Ax);
  EXPECT_LT((Ax - b).norm(), 2e-10 * b.norm());
}

TEST(Failure, ConjugateGradientsAloneNameTheirLimit) {
  const Model model = beam_model(1, CellKind::tet4, 0.3, Strain::small);
  const Equations equations(model);
  BlockMatrix mass(equations.elements().pattern());
  add(mass, 1, equations.mass());
  const auto solver = make_conjugate_gradient(Preconditioner::none);
  ASSERT_EQ(solver->factor(mass, Mask(static_cast<std::size_t>(equations.size()), 0)), LinearStatus::done);
  Vector x;
  EXPECT_EQ(solver->solve(Vector::Ones(equations.size()), 1e-30, x), LinearStatus::limit);
}

// A limit of time ends an increment from inside, in Newton's iteration and in that of the linear solver.
TEST(Failure, AnIncrementEndsWhereItsPulseThrows) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::small);
  model.settings.linear_solver = LinearSolver::cg;
  for (const Preconditioner preconditioner : {Preconditioner::block_jacobi, Preconditioner::multigrid}) {
    model.settings.preconditioner = preconditioner;
    int calls = 0;
    model.settings.pulse = [&] { ++calls; };
    const Outcome whole = solve(model, [](const State&) { return true; });
    EXPECT_GT(calls, whole.cg_iterations);
    EXPECT_GT(whole.cg_iterations, 0);
    model.settings.pulse = [&] {
      if (--calls == 2) throw Error("enough");
    };
    EXPECT_THROW(solve(model, [](const State&) { return true; }), Error);
    EXPECT_EQ(calls, 2);
  }
}

// What takes long between two iterations is looked at in its midst: analysis and factorisation, grid after grid.
TEST(Failure, SetUpsOfLinearSolversEndWhereTheirPulseThrows) {
  const Model model = beam_model(4, CellKind::tet10, 0.3, Strain::small);
  const Equations equations(model);
  BlockMatrix mass(equations.elements().pattern());
  add(mass, 1, equations.mass());
  const Mask none(static_cast<std::size_t>(equations.size()), 0);
  const std::function<void()> enough = [] { throw Error("enough"); };
  EXPECT_THROW(make_cholesky(1, available_memory(), enough)->factor(mass, none), Error);
  EXPECT_THROW(make_indefinite(1, enough)->factor(mass, none), Error);
  EXPECT_THROW(make_unsymmetric(1, enough)->factor(mass, none), Error);
  int calls = 0;
  const auto multigrid = make_multigrid(equations.geometry(), [&] { ++calls; });
  EXPECT_EQ(multigrid->factor(mass, none), LinearStatus::done);
  EXPECT_GE(calls, 2) << "one for each grid below the finest";
}

// Two cubes that share one edge: the second can turn about it.
TEST(Failure, AHingeIsASingularMatrix) {
  Mesh one = box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), two = one;
  two.points.rowwise() += Eigen::RowVector3d(1, 0, 1);
  Model model = make_model(merge({one, two}), {});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom))};
  model.steps[0].gravity = Vec3(0, 0, -1);
  for (const LinearSolver solver : {LinearSolver::direct, LinearSolver::cg}) {
    model.settings.linear_solver = solver;
    const Outcome outcome = solve(model, {});
    EXPECT_NE(outcome.stop, Stop::converged);
    if (solver == LinearSolver::direct) {
      EXPECT_EQ(outcome.stop, Stop::singular) << outcome.diagnosis;
      EXPECT_THAT(outcome.diagnosis, HasSubstr("can move freely"));
    }
  }
}

TEST(Failure, AnInterruptKeepsTheLastState) {
  Model model = beam_model(1, CellKind::tet4, 0.3, Strain::corotated);
  model.settings.integrator = Integrator::newmark;
  model.steps[0].count = 10;
  model.steps[0].dt = 0.01;
  const Outcome outcome = solve(model, [](const State& state) { return state.increment < 3; });
  EXPECT_EQ(outcome.stop, Stop::interrupted);
  EXPECT_EQ(outcome.state.increment, 3);
  EXPECT_NEAR(outcome.state.time, 0.03, 1e-12);
}

TEST(Failure, ADynamicInversionNamesTimeAndIncrement) {
  Model model = squeezed(-1.5);
  model.settings.integrator = Integrator::implicit_euler;
  model.steps[0].dt = 0.1;
  model.steps[0].count = 15;
  for (const int iterations : {1, 25}) {
    model.settings.newton_iterations = iterations;
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::inverted_element) << outcome.diagnosis;
    EXPECT_THAT(outcome.diagnosis, HasSubstr("with dt = 0.1"));
    EXPECT_GT(outcome.check.smallest_J, 0);
  }
}

TEST(Failure, AStartWithoutForcesIsNamedBeforeAnythingIsWritten) {
  for (const Integrator integrator : {Integrator::static_, Integrator::implicit_euler, Integrator::symplectic_euler}) {
    Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {});
    model.regions[0].law = neo_hookean("log", 1000, 0.3);
    model.settings.integrator = integrator;
    model.steps[0].dt = 1e-4;
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.initial_displacement = model.mesh->points * -2;
    int states = 0;
    const Outcome outcome = solve(model, [&](const State&) { return ++states, true; });
    EXPECT_EQ(outcome.stop, Stop::inverted_element) << name(integrator) << outcome.diagnosis;
    EXPECT_EQ(states, 0) << name(integrator);
  }
}

// The state that a run stops in is the last that was found, also between two that are reported.
TEST(Failure, TheLastPieceThatWasFoundIsTheLastGoodState) {
  for (const Integrator integrator :
       {Integrator::static_, Integrator::quasi_static, Integrator::implicit_euler, Integrator::newmark})
    for (const bool adaptive : {false, true}) {
      if (is_dynamic(integrator) && !adaptive) continue;
      Model model = squeezed(-1.5);
      model.settings.integrator = integrator;
      model.settings.adaptive_step = adaptive;
      model.steps[0].dt = 1;
      model.steps[0].count = 1;
      int states = 0;
      const Outcome outcome = solve(model, [&](const State&) { return ++states > 0; });
      EXPECT_EQ(outcome.stop, Stop::inverted_element) << name(integrator) << outcome.diagnosis;
      EXPECT_EQ(states, 1);
      const State& last = outcome.state;
      EXPECT_GT(last.time, 0.5) << name(integrator);
      EXPECT_LT(last.time, 1);
      // The supports move in proportion to the time, and the state belongs to its time.
      const int top = points_where(*model.mesh, at_top).front();
      EXPECT_NEAR(last.displacement(top, 2), -1.5 * last.time, 1e-12) << name(integrator);
      if (!is_dynamic(integrator)) {
        EXPECT_NEAR(last.load_factor, last.time, 1e-12);
      }
      EXPECT_GT(outcome.check.smallest_J, 0);
    }
}

// Of a body in free flight the mass holds all there is to hold: over dt = 1e6 it is lost in the round-off of the
// stiffness, over a tenth of that it is not.
TEST(AdaptiveStep, TriesShorterStepsWhereTheMatrixIsSingular) {
  for (const bool adaptive : {false, true}) {
    Model model =
        make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1, .strain = Strain::small});
    model.settings.integrator = Integrator::newmark;
    model.settings.adaptive_step = adaptive;
    model.steps[0].dt = 1e6;
    model.steps[0].count = 1;
    model.initial_velocity = Points::Constant(model.mesh->point_count(), 3, 1e-6);
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, adaptive ? Stop::converged : Stop::singular) << outcome.diagnosis;
    // It flies straight on, up to what the solutions of such matrices are worth.
    if (adaptive) {
      EXPECT_NEAR(outcome.state.displacement(0, 0), 1, 1e-3);
    }
  }
}

using LawPtr = std::shared_ptr<const Law>;

/// A unit cube whose top is pushed down by forces that grow with t to 1500 at each node in the time 1.
Model pushed_down(LawPtr law, Integrator integrator, int count) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {}, 1);
  model.regions[0].law = std::move(law);
  model.settings.integrator = integrator;
  model.steps[0].dt = 1.0 / count;
  model.steps[0].count = count;
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_bottom))};
  model.steps[0].forces = {{.name = "push",
                            .nodes = points_where(*model.mesh, at_top),
                            .values = {Vec3(0, 0, -1500)},
                            .factor = {[](double t) { return t; }, {}}}};
  return model;
}

// Both laws have forces where elements are inside out, and let a block be pushed through itself.
TEST(Failure, DynamicsThatEndsInsideOutHasFailed) {
  const LawPtr saint_venant =
                   law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}}),
               cubic = neo_hookean("cubic", 1000, 0.3);
  for (const LawPtr& law : {saint_venant, cubic})
    for (const auto& [integrator, count] :
         {std::pair(Integrator::implicit_euler, 20), std::pair(Integrator::central_difference, 4000)}) {
      Model model = pushed_down(law, integrator, count);
      int states = 0;
      const Outcome outcome = solve(model, [&](const State&) { return ++states > 0; });
      EXPECT_LE(outcome.check.smallest_J, 0);
      EXPECT_EQ(outcome.stop, Stop::inverted_element) << name(integrator) << name(outcome.stop);
      EXPECT_EQ(states, count + 1);
      EXPECT_THAT(outcome.diagnosis, HasSubstr("step 1 'load' ended at time 1"));
      EXPECT_THAT(outcome.diagnosis, HasSubstr("inverted element; worst element "));
      model.settings.allow_inverted = true;
      EXPECT_EQ(solve(model, {}).stop, Stop::converged);
    }
}

// The body stiffens until dt is far above the stable step; within a few steps the energy grows to numbers of a hundred
// digits. What is handed back is from before, and its energy is what the load has put in, at least by its size.
TEST(Failure, AnExplicitMotionThatBlowsUpEndsInAStateFromBefore) {
  for (const int count : {200, 500}) {
    double time = 0;
    const Outcome outcome = solve(pushed_down(neo_hookean("cubic", 1000, 0.3), Integrator::central_difference, count),
                                  [&](const State& state) { return time = state.time, true; });
    EXPECT_EQ(outcome.stop, Stop::unstable_step) << name(outcome.stop);
    EXPECT_THAT(outcome.diagnosis, HasSubstr("is unstable above"));
    const State& last = outcome.state;
    EXPECT_LT(last.time, time);
    EXPECT_GT(last.time, 0.3);
    EXPECT_LT(last.energies.elastic + last.energies.kinetic, 3 * last.energies.external_work);
    EXPECT_GT(outcome.check.smallest_J, -2);
    Model model = pushed_down(neo_hookean("cubic", 1000, 0.3), Integrator::central_difference, count);
    model.settings.allow_unstable = true;  // goes on to the end of numbers
    EXPECT_GT(solve(model, {}).state.energies.kinetic, 1e50);
  }
}

}  // namespace
}  // namespace msml::fe
