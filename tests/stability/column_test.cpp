// SPDX-License-Identifier: GPL-3.0-or-later
// A slender column whose stiffness across falls to zero: how far Newton holds, and what comes after.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr double length = 20, young = 1000, bending = young / 12;  // E I of a section of 1 x 1

/// Euler's load of a column that is held at one end, lowered by shear of shape factor 1.2 with G = E / 2: P_E / (1 +
/// 1.2 P_E / (G A)), Timoshenko and Gere 1961, Theory of elastic stability, section 2.17.
double critical_load() {
  const double euler = M_PI * M_PI * bending / (4 * length * length);
  return euler / (1 + 1.2 * euler / (young / 2));
}

std::vector<std::shared_ptr<const Law>> laws() {
  return {make_linear_elastic({.youngs_modulus = young, .poisson_ratio = 0}),
          law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", young}, {"poissonRatio", 0.0}})};
}

struct Pressed {
  Vec3 tip;  ///< its displacement
  Outcome outcome;
};

/// The column [0,20] x [0,1] x [0,1], held at x = 0, under dead forces at its end: `along` it and `across`, in z.
Pressed pressed(const std::shared_ptr<const Law>& law, double along, double across, int divisions = 20) {
  Model model = make_model(box_mesh(divisions, 1, 1, {length, 1, 1}, CellKind::tet10), {});
  model.regions[0].law = law;
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  FaceLoad load{.name = "press", .tractions = {Vec3(-along, 0, across)}};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > length - 1e-9; });
  model.steps[0].face_loads = {load};
  Outcome outcome = solve(model, {});
  const int tip = nearest_point(*model.mesh, {length, 0.5, 0.5});
  return {outcome.state.displacement.row(tip).transpose(), outcome};
}

/// How much more a force across bends the column that is pressed by the share p of its critical load: 3 (tan u - u) /
/// u^3 with u = pi/2 sqrt(p), which lies between 0.985 and 1 of 1 / (1 - p) (Timoshenko and Gere 1961, section 1.11).
double amplification(double p) {
  const double u = M_PI / 2 * std::sqrt(p);
  return 3 * (std::tan(u) - u) / (u * u * u);
}

/// The share of the critical load that amplifies so.
double share_of(double amplified) {
  double low = 1e-6, high = 1 - 1e-12;
  for (int i = 0; i < 100; ++i) (amplification(0.5 * (low + high)) < amplified ? low : high) = 0.5 * (low + high);
  return low;
}

// A force that bends the free column by 1e-6 of its length: 1e-3 where it is amplified a thousand times, at which a
// column is stiffer by less than 1e-6 of its critical load.
TEST(Column, BendsAsTheAmplificationSaysUpToAThousandthBelowItsCriticalLoad) {
  const double across = 1e-6 * 3 * bending / (length * length);
  for (const auto& law : laws()) {
    const double unpressed = pressed(law, 0, across).tip[2];
    EXPECT_NEAR(unpressed, 1e-6 * length, 0.005 * 1e-6 * length);  // shear: 0.0015
    const auto amplified = [&](double load) {
      const Pressed now = pressed(law, load, across);
      EXPECT_EQ(now.outcome.stop, Stop::converged) << now.outcome.diagnosis;
      return now.tip[2] / unpressed;
    };
    const double near = 0.99 * critical_load(), critical = near / share_of(amplified(near));
    // The strain before buckling, 5e-4, counts in the law as it may.
    EXPECT_NEAR(critical / critical_load(), 1, 0.001) << law->name();
    EXPECT_NEAR(amplified(0.9 * critical) / amplification(0.9), 1, 0.002) << law->name();
    // An error of 3e-5 in the critical load is one of 3 % here.
    EXPECT_NEAR(amplified(0.999 * critical) / amplification(0.999), 1, 0.03) << law->name();
  }
}

TEST(Column, StandsStraightJustBelowItsCriticalLoadAndIsCalledUnstableJustAbove) {
  for (const auto& law : laws()) {
    const Pressed below = pressed(law, 0.998 * critical_load(), 0), above = pressed(law, 1.002 * critical_load(), 0);
    EXPECT_EQ(below.outcome.stop, Stop::converged) << law->name() << ": " << below.outcome.diagnosis;
    EXPECT_LT(std::hypot(below.tip[1], below.tip[2]), 1e-9 * length);
    EXPECT_EQ(above.outcome.stop, Stop::indefinite_tangent) << law->name();
    EXPECT_THAT(above.outcome.diagnosis, HasSubstr("the body buckles or the equilibrium is unstable"));
    EXPECT_TRUE(above.outcome.state.displacement.allFinite());
  }
}

// The elastica whose end has turned by 40 degrees: with k = sin 20, P / P_cr = (2 K / pi)^2 = 1.0637, it is 2 k / K =
// 0.4222 of its length aside and 2 (1 - E / K) = 0.1188 nearer (Timoshenko and Gere 1961, section 2.7). The critical
// load is known to 0.1 %, in which the square of the way aside grows by 1.6 %; the force across adds as much.
TEST(Column, GoesOverToTheBentBranchWhereAForceAcrossLeadsThere) {
  const double k = std::sin(M_PI / 9), K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
  const double load = std::pow(2 * K / M_PI, 2) * critical_load();
  for (const auto& law : laws()) {
    const Pressed bent = pressed(law, load, 1e-4 * load, 10);
    ASSERT_EQ(bent.outcome.stop, Stop::converged) << law->name() << ": " << bent.outcome.diagnosis;
    EXPECT_NEAR(std::hypot(bent.tip[1], bent.tip[2]) / length, 2 * k / K, 0.02 * 2 * k / K) << law->name();
    EXPECT_NEAR(-bent.tip[0] / length, 2 * (1 - E / K), 0.03 * 2 * (1 - E / K)) << law->name();
  }
}

}  // namespace
}  // namespace msml::fe
