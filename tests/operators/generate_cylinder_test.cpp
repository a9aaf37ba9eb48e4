// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateCylinderMesh against the volume of inscribed prisms and of the cylinder.
#include <cmath>
#include <numbers>

#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

constexpr double pi = std::numbers::pi;

Arguments cylinder(double inner, bool quarter, Integer around = 2) {
  return {{"radius", 2.0},        {"innerRadius", inner}, {"height", 3.0},     {"around", around},
          {"across", Integer{3}}, {"along", Integer{4}},  {"quarter", quarter}};
}

/// Area of the regular polygon with n corners on a circle.
double polygon(double radius, int n) { return n / 2.0 * radius * radius * std::sin(2 * pi / n); }

TEST(GenerateCylinder, FillsTheInscribedPrism) {
  const auto mesh = output<Mesh>(run("GenerateCylinderMesh", cylinder(0, false)));
  // 8 parts of 45 degrees with 2 divisions each: 16 corners.
  EXPECT_NEAR(total_volume(*mesh), 3 * polygon(2, 16), 1e-11);  // round-off
  EXPECT_GT(smallest_volume(*mesh), 0);
  EXPECT_EQ(euler_characteristic(*mesh), 1);
}

TEST(GenerateCylinder, TubeHasAHoleThroughIt) {
  const auto mesh = output<Mesh>(run("GenerateCylinderMesh", cylinder(1, false)));
  EXPECT_NEAR(total_volume(*mesh), 3 * (polygon(2, 16) - polygon(1, 16)), 1e-11);  // round-off
  EXPECT_EQ(euler_characteristic(*mesh), 0);
}

TEST(GenerateCylinder, QuarterIsAQuarterWithCutsInTheirPlanes) {
  for (const double inner : {0.0, 1.0}) {
    const auto whole = output<Mesh>(run("GenerateCylinderMesh", cylinder(inner, false)));
    const auto part = output<Mesh>(run("GenerateCylinderMesh", cylinder(inner, true)));
    EXPECT_NEAR(total_volume(*part), total_volume(*whole) / 4, 1e-11);  // round-off
    EXPECT_GT(smallest_volume(*part), 0);
    EXPECT_EQ(part->points.leftCols<2>().minCoeff(), 0);
    EXPECT_EQ(euler_characteristic(*part), 1);
  }
}

TEST(GenerateCylinder, QuadraticMidNodesLieOnTheSurface) {
  Arguments arguments = cylinder(1, false);
  arguments["quadratic"] = true;
  const auto mesh = output<Mesh>(run("GenerateCylinderMesh", arguments));
  long outside = 0;
  for (int i = 0; i < mesh->point_count(); ++i) {
    const double r = mesh->points.row(i).head<2>().norm();
    EXPECT_LT(r, 2 + 1e-12);  // a chord's middle lies inside, a bent edge's on the circle: none beyond
    EXPECT_GT(r, 1 - 1e-12);
    outside += r > 2 - 1e-12;
  }
  // On the outer circle: 32 places around (corners and middles) at 9 heights (levels and middles).
  EXPECT_EQ(outside, 32 * 9);
}

TEST(GenerateCylinder, RefusesAHoleWiderThanTheCylinder) {
  EXPECT_EQ(error_of("GenerateCylinderMesh", cylinder(2, false)), "innerRadius = 2 is not below radius = 2");
}

}  // namespace
}  // namespace msml::test
