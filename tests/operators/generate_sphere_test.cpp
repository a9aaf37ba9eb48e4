// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateSphereMesh against the volumes of balls and shells.
#include <cmath>
#include <numbers>

#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

constexpr double pi = std::numbers::pi;

Arguments sphere(double inner, bool octant, Integer around, bool quadratic = false) {
  return {{"center", std::vector<double>{1, 2, 3}},
          {"radius", 2.0},
          {"innerRadius", inner},
          {"around", around},
          {"across", around},
          {"octant", octant},
          {"quadratic", quadratic}};
}

double ball(double radius) { return 4 * pi / 3 * radius * radius * radius; }

/// Relative error of the volume of straight tetrahedra.
double error(double inner, Integer around) {
  const auto mesh = output<Mesh>(run("GenerateSphereMesh", sphere(inner, true, around)));
  return std::abs(8 * total_volume(*mesh) / (ball(2) - ball(inner)) - 1);
}

TEST(GenerateSphere, VolumeErrorFallsWithTheSquareOfTheSpacing) {
  for (const double inner : {0.0, 1.0}) {
    EXPECT_LT(error(inner, 8), 0.01);                         // (pi/32)^2 is 1 %
    EXPECT_NEAR(error(inner, 4) / error(inner, 8), 4, 0.15);  // second order, measured at finite spacing
  }
}

TEST(GenerateSphere, HasTheShapeItIsNamedFor) {
  const auto full = output<Mesh>(run("GenerateSphereMesh", sphere(0, false, 3)));
  const auto shell = output<Mesh>(run("GenerateSphereMesh", sphere(1, false, 3)));
  const auto octant = output<Mesh>(run("GenerateSphereMesh", sphere(1, true, 3)));
  EXPECT_EQ(euler_characteristic(*full), 1);
  EXPECT_EQ(euler_characteristic(*shell), 2);
  EXPECT_EQ(euler_characteristic(*octant), 1);
  for (const auto& mesh : {full, shell, octant}) EXPECT_GT(smallest_volume(*mesh), 0);
  // Not equal: diagonals of the bent squares may run the other way, which moves a part of (pi/12)^3 of the volume.
  EXPECT_NEAR(8 * total_volume(*octant) / total_volume(*shell), 1, 1e-3);
}

TEST(GenerateSphere, OctantIsCutExactlyInTheCoordinatePlanes) {
  const auto mesh = output<Mesh>(run("GenerateSphereMesh", sphere(1, true, 3)));
  EXPECT_EQ(mesh->points.colwise().minCoeff(), Eigen::RowVector3d(1, 2, 3));
  const long in_plane = (mesh->points.col(0).array() == 1).count();
  // The quarter ring x = 1: 6 divisions of 90 degrees, 3 across.
  EXPECT_EQ(in_plane, 7 * 4);
}

TEST(GenerateSphere, CurvedElementsReachTheVolumeTwoOrdersEarlier) {
  const auto curved_error = [](Integer around) {
    const Value mesh = run("GenerateSphereMesh", sphere(1, true, around, true));
    const auto measured = output<Mesh>(run("MeasureMeshQuality", {{"mesh", mesh}}));
    double volume = 0;
    for (const double v : measured->cell_fields.front().values) volume += v;
    for (const double j : measured->cell_fields.back().values) EXPECT_GT(j, 0);
    return std::abs(8 * volume / (ball(2) - ball(1)) - 1);
  };
  EXPECT_LT(curved_error(4), error(1, 4) / 50);
  EXPECT_GT(curved_error(2) / curved_error(4), 12);  // fourth order: 16 in the limit
}

TEST(GenerateSphere, RefusesACavityWiderThanTheBall) {
  EXPECT_EQ(error_of("GenerateSphereMesh", sphere(2.5, false, 2)), "innerRadius = 2.5 is not below radius = 2");
}

}  // namespace
}  // namespace msml::test
