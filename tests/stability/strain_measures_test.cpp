// SPDX-License-Identifier: GPL-3.0-or-later
// Where strain measures stop being right: small strain in large rotations, and rotations of mirrored or coarse
// elements.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

#include "tests/solver/laws.hpp"
#include "tests/stability/bars.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// A cube of which every node is turned about z by an angle.
Model turned(double angle, Strain strain) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4),
                           {.youngs_modulus = 1000, .poisson_ratio = 0.3, .strain = strain});
  Prescribed all{.name = "turned"};
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  for (int n = 0; n < model.mesh->point_count(); ++n) {
    const Vec3 X = model.mesh->points.row(n).transpose();
    all.nodes.push_back(n);
    all.values.push_back(R * X - X);
  }
  model.steps[0].prescribed = {all};
  return model;
}

// A turn by theta is read as the strain (cos theta - 1) across the axis: its stresses by Hooke's law, in closed form.
TEST(SmallStrain, ReadsARigidTurnAsStress) {
  const double mu = 1000 / 2.6, lambda = 1000 * 0.3 / (1.3 * 0.4);
  for (const double degrees : {10.0, 45.0, 90.0}) {
    const double strain = std::cos(degrees * M_PI / 180) - 1;
    const Model model = turned(degrees * M_PI / 180, Strain::small);
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const ElementResults found = element_results(model, outcome.state);
    EXPECT_NEAR(found.cauchy[0], 2 * (lambda + mu) * strain, 1e-9 * mu) << degrees;  // round-off
    EXPECT_NEAR(found.cauchy[2], 2 * lambda * strain, 1e-9 * mu) << degrees;
    EXPECT_NEAR(outcome.check.largest_rotation, degrees, 1e-6);  // what the warning is made of
    const Model following = turned(degrees * M_PI / 180, Strain::corotated);
    const Outcome free = solve(following, {});
    EXPECT_NEAR(element_results(following, free.state).cauchy[0], 0, 1e-9 * mu) << degrees;
  }
}

// A bar bent by an end moment whose linear theory turns the end by kappa L: F = [[1 - kappa z, -kappa x], [kappa x,
// 1]], so that the volume grows by (kappa L)^2/3 in the mean, where the true bar keeps it.
TEST(SmallStrain, SwellsABentBarByTheSquareOfItsRotation) {
  for (const double end : {0.1, M_PI / 4, M_PI / 2}) {
    const Model model = bent_bar(CellKind::tet10, 1, 0, end / bar_length);
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    // Quadratic elements hold the solution exactly; 1e-6 is left to Newton's tolerance and to round-off.
    EXPECT_NEAR(outcome.check.volume_change, end * end / 3, 1e-6) << end;
  }
}

// F = diag(-1, 1, 1): the nearest rotation leaves the stretches (-1, 1, 1), so W = mu 4 + lambda/2 4. A reflection
// taken for a rotation would find no strain at all.
TEST(Corotated, AMirroredElementIsStrained) {
  const double mu = 1000 / 2.6, lambda = 1000 * 0.3 / (1.3 * 0.4);
  const auto law = make_linear_elastic({.youngs_modulus = 1000, .poisson_ratio = 0.3, .strain = Strain::corotated});
  Random random;
  for (int k = 0; k < 20; ++k) {
    const Mat3 R = random.rotation();
    const Point mirrored = evaluate(*law, R * Vec3(-1, 1, 1).asDiagonal());
    EXPECT_NEAR(mirrored.energy, 4 * mu + 2 * lambda, 1e-6 * mu);  // which axis is turned is not unique here
    EXPECT_TRUE(mirrored.P.allFinite());
    EXPECT_NEAR(evaluate(*law, R).energy, 0, 1e-12 * mu);
  }
}

/// Root mean square over the nodes of the difference of displacements between a bar of n x n x 4n cubes twisted by
/// `angle` and the finer one.
double twist_error(Formulation formulation, int n, double angle, const Model& fine, const State& reference) {
  Model model = twisted_bar(CellKind::tet10, n, angle);
  model.formulation = formulation;
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  double sum = 0;
  for (int k = 0; k < model.mesh->point_count(); ++k) {
    const Vec3 X = model.mesh->points.row(k).transpose();
    sum += (outcome.state.displacement.row(k) - reference.displacement.row(nearest_point(*fine.mesh, X))).squaredNorm();
  }
  return std::sqrt(sum / model.mesh->point_count());
}

// One rotation from the corners holds inside one element only as far as the twist turns it little.
TEST(SingleRotation, MissesTheTwistOfACoarseBarAndCatchesUp) {
  const double angle = M_PI / 2;
  const Model fine = twisted_bar(CellKind::tet10, 4, angle);
  const Outcome reference = solve(fine, {});
  ASSERT_EQ(reference.stop, Stop::converged) << reference.diagnosis;
  double excess[2];
  for (const int n : {1, 2}) {
    const double single = twist_error(Formulation::single_rotation, n, angle, fine, reference.state);
    const double standard = twist_error(Formulation::standard, n, angle, fine, reference.state);
    std::cout << "bar twisted by 90 degrees, " << n << " x " << n << " x " << 4 * n << ": RMS of tet10 " << standard
              << ", of tet10SR " << single << "\n";
    excess[n - 1] = single / standard;
  }
  EXPECT_GT(excess[0], 2);  // misses the rotation on the coarsest mesh, where tet10 has half its error or less
  EXPECT_LT(excess[1], 0.8 * excess[0]);
}

}  // namespace
}  // namespace msml::fe
