// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients where matrices are badly conditioned: Poisson's ratio near one half, and elements without height.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

struct Solved {
  long iterations;
  bool gave_up;
  double difference;  ///< of the displacement from that of the direct solver, relative
};

Solved solved(Model model, Preconditioner preconditioner) {
  model.settings.linear_solver = LinearSolver::direct;
  const Points direct = solve(model, {}).state.displacement;
  model.settings.linear_solver = LinearSolver::cg;
  model.settings.preconditioner = preconditioner;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return {outcome.cg_iterations, outcome.cg_gave_up, (outcome.state.displacement - direct).norm() / direct.norm()};
}

constexpr std::array<Preconditioner, 4> preconditioners{Preconditioner::none, Preconditioner::jacobi,
                                                        Preconditioner::incomplete_cholesky, Preconditioner::multigrid};
constexpr std::array<const char*, 4> names{"none", "jacobi", "incompleteCholesky", "multigrid"};

// The condition number grows with the bulk modulus, 1/(1 - 2 nu), and iterations at most with its root: from .3 to
// .4999 a factor of sqrt(.4/.0002) = 45, beside the deflation of a few large eigenvalues that conjugate gradients do.
TEST(ConjugateGradients, TakeMoreIterationsTowardsIncompressibility) {
  for (std::size_t p = 0; p < 4; ++p) {
    std::vector<long> found;
    for (const double nu : {0.3, 0.45, 0.49, 0.499, 0.4999}) {
      const Solved run = solved(beam_model(2, CellKind::tet10, nu, Strain::small), preconditioners[p]);
      found.push_back(run.iterations);
      std::printf("%-18s nu = %-6g: %ld iterations%s\n", names[p], nu, run.iterations, run.gave_up ? ", gave up" : "");
      // linearTolerance 1e-10 on the residual; the displacement's error is at most the condition number times that.
      EXPECT_LT(run.difference, 1e-5) << names[p] << " " << nu;
    }
    EXPECT_GT(found.back(), 2 * found.front()) << names[p];
    EXPECT_LT(found.back(), 45 * found.front()) << names[p];
  }
}

/// The beam with its middle node pressed towards a face of one of its elements: to `height` of the way that is there.
Model with_sliver(double height) {
  Model model = beam_model(2, CellKind::tet4, 0.3, Strain::small);
  Mesh mesh = *model.mesh;
  const int node = nearest_point(mesh, {0.05, 0.01, 0.01});
  for (int e = 0; e < mesh.cell_count(); ++e) {
    const int* c = mesh.cell(e);
    for (int a = 0; a < 4; ++a) {
      if (c[a] != node) continue;
      Vec3 foot = Vec3::Zero();
      for (int b = 0; b < 4; ++b)
        if (b != a) foot += mesh.points.row(c[b]).transpose() / 3;
      mesh.points.row(node) = (foot + height * (mesh.points.row(node).transpose() - foot)).transpose();
      model.mesh = std::make_shared<const Mesh>(mesh);
      return model;
    }
  }
  return model;
}

// The stiffness of an element of height h grows as 1/h. It adds a few large eigenvalues, which cost conjugate gradients
// a few iterations each and more where round-off brings them back; the answer stays right, as the matrix is factorised
// where the tolerance is missed.
TEST(ConjugateGradients, TakeMoreIterationsWithAWorseElement) {
  for (std::size_t p = 0; p < 3; ++p) {
    std::vector<long> found;
    for (const double height : {1.0, 1e-1, 1e-2, 1e-4, 1e-6}) {
      const Solved run = solved(with_sliver(height), preconditioners[p]);
      found.push_back(run.iterations);
      std::printf("%-18s height %-5g: %ld iterations%s\n", names[p], height, run.iterations,
                  run.gave_up ? ", gave up: factorised" : "");
      EXPECT_LT(run.difference, 1e-4) << names[p] << " " << height;
    }
    EXPECT_GT(found.back(), found.front()) << names[p];
  }
}

}  // namespace
}  // namespace msml::fe
