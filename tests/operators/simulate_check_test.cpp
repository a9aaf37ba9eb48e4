// SPDX-License-Identifier: GPL-3.0-or-later
// The check: its warnings, its block of lines, its JSON; and the shape of tetrahedra.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "operators/simulate/check_report.hpp"
#include "operators/simulate/state_fields.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::check_warnings;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

simulation::Simulation simulation_of(double poisson, const std::string& strain = "corotated") {
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  scene.regions = {
      region(language, "tissue", std::get<IndexSetPtr>(scene.regions[0].values[0]), 1000, poisson, strain)};
  return simulation::build_model(scene.record(language), listener, 1);
}

fe::Outcome harmless() {
  fe::Outcome outcome;
  outcome.check.smallest_J = 0.9;
  outcome.check.smallest_J_element = 3;
  return outcome;
}

TEST(CheckWarnings, AHarmlessRunHasNone) {
  const auto simulation = simulation_of(0.44);
  EXPECT_THAT(check_warnings(simulation, harmless(), worst_shape(simulation.body)), IsEmpty());
}

TEST(CheckWarnings, LinearTetrahedraLockFromPoissonRatio045) {
  const auto simulation = simulation_of(0.45);
  EXPECT_THAT(
      check_warnings(simulation, harmless(), {}),
      ElementsAre("region 'tissue' has poissonRatio = 0.45: linear tetrahedra lock (are too stiff) from 0.45. Use "
                  "formulation=\"fbar\", or quadraticTet with the mesh from ConvertLinearToQuadraticTetrahedralMesh"));
}

TEST(CheckWarnings, SmallStrainPastTenDegreesOfRotation) {
  auto outcome = harmless();
  outcome.check.largest_rotation = 12.34;
  const simulation::WorstShape good{.smallest_angle = 40, .angle_element = 0};
  EXPECT_THAT(
      check_warnings(simulation_of(0.3, "small"), outcome, good),
      ElementsAre("an element rotates by 12.3 degrees, but strain = \"small\" holds up to about 10. Use strain = "
                  "\"corotated\""));
  EXPECT_THAT(check_warnings(simulation_of(0.3), outcome, good), IsEmpty());
  outcome.check.largest_rotation = 9.9;
  EXPECT_THAT(check_warnings(simulation_of(0.3, "small"), outcome, good), IsEmpty());
}

TEST(CheckWarnings, AnElementNearInversion) {
  auto outcome = harmless();
  outcome.check.smallest_J = 0.05;
  outcome.check.smallest_J_element = 0;
  const simulation::WorstShape good{.smallest_angle = 40, .angle_element = 0};
  EXPECT_THAT(
      check_warnings(simulation_of(0.3), outcome, good),
      ElementsAre("element 0 at (0.375, 0.25, 0.125) is near inversion: J = 0.05, below 0.1. Lower the load, or "
                  "refine the mesh there"));
}

TEST(CheckWarnings, AnInvertedElement) {
  auto outcome = harmless();
  outcome.check.smallest_J = -2.17;
  outcome.check.smallest_J_element = 0;
  const simulation::WorstShape good{.smallest_angle = 40, .angle_element = 0};
  EXPECT_THAT(check_warnings(simulation_of(0.3), outcome, good),
              ElementsAre("element 0 at (0.375, 0.25, 0.125) is inverted: J = -2.17. Lower the load, or refine the "
                          "mesh there"));
}

TEST(CheckWarnings, ATimeStepThatDampsTheLowestPeriod) {
  auto outcome = harmless();
  outcome.check.damped_per_cycle = 0.3;
  outcome.check.lowest_period = 2;
  const simulation::WorstShape good{.smallest_angle = 40, .angle_element = 0};
  EXPECT_THAT(check_warnings(simulation_of(0.3), outcome, good),
              ElementsAre("the time step damps the lowest period, 2, by 30 % a cycle. Take dt below 0.0052, or "
                          "timeIntegration = \"Newmark\""));
  // Implicit Euler shrinks an amplitude by 1/sqrt(1 + (w dt)^2) a step: the advice keeps its promise.
  const double dt = 0.0052, w = 2 * EIGEN_PI / 2, steps = 2 / dt;
  EXPECT_NEAR(1 - std::pow(1 + w * w * dt * dt, -steps / 2), 0.05, 0.001);  // dt has two digits
}

TEST(CheckWarnings, ASliver) {
  const simulation::WorstShape sliver{.smallest_angle = 0.25, .angle_element = 0};
  EXPECT_THAT(
      check_warnings(simulation_of(0.3), harmless(), sliver),
      ElementsAre("element 0 at (0.375, 0.25, 0.125) is a sliver: a dihedral angle of 0.25 degrees. Improve the "
                  "mesh, for example with exude = \"true\""));
}

TEST(CheckReport, ColumnsAreAligned) {
  const auto simulation = simulation_of(0.3);
  const std::string text = check_text(simulation, harmless(), worst_shape(simulation.body), {});
  EXPECT_THAT(text, HasSubstr("check of 'cube' at t = 0\n"));
  EXPECT_THAT(text, HasSubstr("\n  smallest J              0.9 (element 3 at (0.375, 0.125, 0.25))\n"));
  EXPECT_THAT(text, HasSubstr("\n  smallest dihedral angle 45 degrees (element "));
}

TEST(CheckReport, AStoppedRunShowsItsLastGoodStateWithoutABalance) {
  const auto simulation = simulation_of(0.3);
  auto outcome = harmless();
  outcome.stop = fe::Stop::diverged;
  const std::string text = check_text(simulation, outcome, worst_shape(simulation.body), {});
  EXPECT_THAT(text, HasSubstr("at t = 0, the last good state (stopped: diverged)\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("residual")));
}

TEST(CheckReport, ADynamicRunTellsItsStepsPerSecondAndWhereTheTimeWent) {
  auto simulation = simulation_of(0.3);
  auto outcome = harmless();
  outcome.state.increment = 50;
  outcome.seconds_setup = 0.5;
  outcome.seconds_assembly = 0.25;
  outcome.seconds_linear = 1.5;
  const simulation::RunTimes times{.steps = 2, .output = 0.125};
  simulation.model.settings.integrator = fe::Integrator::implicit_euler;
  const std::string text = check_text(simulation, outcome, worst_shape(simulation.body), times);
  EXPECT_THAT(text, HasSubstr("\n  time                    0.5 s set-up, 0.25 s assembly, 1.5 s linear systems, 0.25 s "
                              "rest, 0.125 s output\n  steps per second        25\n"));
  simulation.model.settings.integrator = fe::Integrator::static_;
  EXPECT_THAT(check_text(simulation, outcome, worst_shape(simulation.body), times),
              testing::Not(HasSubstr("per second")));
}

TEST(CheckReport, JsonHoldsNullForWhatIsNotANumber) {
  const auto simulation = simulation_of(0.3);
  auto outcome = harmless();
  outcome.check.smallest_J = std::numeric_limits<double>::infinity();
  outcome.diagnosis = "a \"quoted\" word";
  const auto json =
      nlohmann::json::parse(check_json(simulation, outcome, worst_shape(simulation.body), {}, {"careful"}));
  EXPECT_TRUE(json["smallestJ"]["value"].is_null());
  EXPECT_EQ(json["diagnosis"], "a \"quoted\" word");
  EXPECT_EQ(json["warnings"][0], "careful");
}

TEST(ElementQuality, TheRegularTetrahedronIsPerfect) {
  const auto shape = simulation::tetrahedron_shape({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1});
  EXPECT_NEAR(shape.smallest_angle, std::acos(1.0 / 3) * 180 / EIGEN_PI, 1e-12);
  EXPECT_NEAR(shape.radius_ratio, 1, 1e-12);
}

TEST(ElementQuality, TheCornerOfACubeHasItsKnownShape) {
  const auto shape = simulation::tetrahedron_shape({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(shape.smallest_angle, std::acos(1 / std::sqrt(3.0)) * 180 / EIGEN_PI, 1e-12);
  // r_in = 1/(3 + sqrt 3), R_out = sqrt(3)/2
  EXPECT_NEAR(shape.radius_ratio, 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), 1e-12);
}

TEST(ElementQuality, AFlatTetrahedronHasNeitherAngleNorRadius) {
  const auto shape = simulation::tetrahedron_shape({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0});
  EXPECT_EQ(shape.smallest_angle, 0);
  EXPECT_EQ(shape.radius_ratio, 0);
}

TEST(ElementQuality, TheWorstElementIsFound) {
  Mesh mesh = box(2, 1, 1);
  // Pulling one corner of the second cube along its edge flattens the elements there.
  mesh.points.row(2) = Eigen::RowVector3d(1.1, 0, 0);
  const auto body = simulation::make_body(std::make_shared<const Mesh>(mesh), CellKind::tet4);
  const auto worst = worst_shape(body);
  EXPECT_GE(worst.ratio_element, 6);
  EXPECT_LT(worst.radius_ratio, 0.2);
}

TEST(VonMises, OfUniaxialTensionIsTheStressAndOfPressureIsZero) {
  EXPECT_THAT(simulation::von_mises({7, 0, 0, 0, 0, 0, 3, 3, 3, 0, 0, 0}), ElementsAre(7, 0));
  EXPECT_NEAR(simulation::von_mises({0, 0, 0, 2, 0, 0})[0], 2 * std::sqrt(3.0), 1e-15);  // pure shear
}

}  // namespace
}  // namespace msml::test
