// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of conditions as expressions and tables, and the conditions that came with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using simulation::Simulation;
using testing::ElementsAre;

/// The model of the cube with one condition.
fe::Model build(const std::string& tag, const Attributes& attributes, const std::string& for_step = "") {
  static const Language language;
  Listener listener;
  Scene scene = cube(language);
  if (tag == "initialVelocity") scene.solver["timeIntegration"] = std::string("Newmark");
  scene.constraints = {condition(language, tag, attributes, for_step)};
  return build_model(scene.record(language), listener, 1).model;
}

std::string refusal(const std::string& tag, const Attributes& attributes) {
  try {
    build(tag, attributes);
  } catch (const Error& error) {
    return error.str();
  }
  return "";
}

IndexSetPtr nodes(std::vector<int> ids) { return index_set(nullptr, Indexed::nodes, std::move(ids)); }

Formulas formulas(const std::vector<std::string>& texts) {
  Formulas list;
  for (const std::string& text : texts) list.push_back(text == "0" ? Formula(0.0) : Formula(text));
  return list;
}

// Point 26 of the cube is its corner (1 1 1), point 2 its corner (1 0 0).
TEST(Expressions, OfPlaceAreValuesAtTheNodesAndRamp) {
  const fe::Model model =
      build("displacementConstraint", {{"indices", nodes({26, 2})}, {"displacement", formulas({"X + Y", "0", "2*Z"})}});
  const fe::Prescribed& moved = model.steps[0].prescribed.at(0);
  EXPECT_FALSE(moved.function);
  EXPECT_EQ(moved.ramp, fe::Ramp::linear);
  EXPECT_THAT(moved.values, ElementsAre(Vec3(2, 0, 2), Vec3(1, 0, 0)));
}

TEST(Expressions, OfTimeAreFunctions) {
  const fe::Model model =
      build("forceConstraint", {{"indices", nodes({26})}, {"force", formulas({"X*t", "0", "t^2"})}});
  EXPECT_EQ(model.steps[0].forces.at(0).function(Vec3(2, 0, 0), 3), Vec3(6, 0, 9));
}

TEST(Expressions, OfAFaceLoadAreSteadyWithoutTime) {
  const IndexSetPtr top = nodes({18, 19, 20, 21, 22, 23, 24, 25, 26});
  const fe::FaceLoad steady =
      build("surfacePressure", {{"indices", top}, {"pressure", formulas({"X"})}}).steps[0].face_loads.at(0);
  EXPECT_TRUE(steady.steady);
  EXPECT_EQ(steady.pressure_function(Vec3(3, 0, 0), 7), 3);
  const fe::FaceLoad timed =
      build("surfaceTraction", {{"indices", top}, {"traction", formulas({"t", "0", "X"})}}).steps[0].face_loads.at(0);
  EXPECT_FALSE(timed.steady);
  EXPECT_EQ(timed.traction_function(Vec3(3, 0, 0), 7), Vec3(7, 0, 3));
}

TEST(Expressions, InAListPerNodeAreRefused) {
  EXPECT_EQ(
      refusal("forceConstraint", {{"indices", nodes({0, 1})}, {"force", formulas({"t", "0", "0", "0", "0", "0"})}}),
      "scene.xml:7: forceConstraint: force has expressions in a list of one vector per node; write 3 expressions "
      "for all nodes, where X, Y and Z tell them apart");
}

TEST(Expressions, ThatAreNotFiniteAtANodeAreRefused) {
  EXPECT_EQ(refusal("forceConstraint", {{"indices", nodes({0})}, {"force", formulas({"1/X", "0", "0"})}}),
            "scene.xml:7: force = 1/X is inf at X = 0, Y = 0, Z = 0, t = 0, which is not finite");
}

TEST(Tables, AreLinearBetweenTimesAndConstantOutside) {
  const fe::Model model = build("forceConstraint", {{"indices", nodes({26})},
                                                    {"force", std::vector<double>{0, 0, 1}},
                                                    {"table", std::vector<double>{1, 10, 2, 20, 4, 0}}});
  const fe::TimeFunction& factor = model.steps[0].forces.at(0).factor;
  EXPECT_EQ(factor(0), 10);
  EXPECT_EQ(factor(1.5), 15);
  EXPECT_EQ(factor(2), 20);
  EXPECT_EQ(factor(3), 10);
  EXPECT_EQ(factor(9), 0);
}

TEST(BodyForce, ActsOnTheElementsItNames) {
  const Attributes force{{"force", std::vector<double>{0, 0, -3}}};
  EXPECT_EQ(build("bodyForce", force).steps[0].body_forces.at(0).elements.size(), 48u);
  Attributes part = force;
  part["indices"] = index_set(nullptr, Indexed::elements, {4, 7});
  const fe::Model model = build("bodyForce", part);
  EXPECT_THAT(model.steps[0].body_forces.at(0).elements, ElementsAre(4, 7));
  EXPECT_EQ(model.steps[0].body_forces.at(0).value, Vec3(0, 0, -3));
  part["indices"] = nodes({0});
  EXPECT_EQ(refusal("bodyForce", part),
            "scene.xml:7: bodyForce: indices holds no element; the body spans (0, 0, 0) to (1, 1, 1)");
}

TEST(SymmetryPlane, AcrossAnAxisHoldsOneComponent) {
  const fe::Model model =
      build("symmetryPlane", {{"indices", nodes({3, 5})}, {"normal", std::vector<double>{0, -2, 0}}});
  const fe::Prescribed& held = model.steps[0].prescribed.at(0);
  EXPECT_THAT(held.components, ElementsAre(false, true, false));
  EXPECT_THAT(held.nodes, ElementsAre(3, 5));
}

TEST(Tables, ScaleGravityToo) {
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  scene.steps = {language.tag(
      "step", "step", {{"gravity", std::vector<double>{0, 0, -10}}, {"table", std::vector<double>{0, 0, 2, 1}}})};
  const fe::Step step = build_model(scene.record(language), listener, 1).model.steps[0];
  EXPECT_FALSE(step.gravity_steady);
  EXPECT_EQ(step.gravity_function(Vec3(1, 2, 3), 1), Vec3(0, 0, -5));
  EXPECT_EQ(step.gravity_function(Vec3(1, 2, 3), 9), Vec3(0, 0, -10));
}

TEST(SymmetryPlane, ObliqueIsASlide) {
  const fe::Model model = build("roller", {{"indices", nodes({3, 5})}, {"normal", std::vector<double>{0, 3, 4}}});
  EXPECT_TRUE(model.steps[0].prescribed.empty());
  EXPECT_LT((model.steps[0].slides.at(0).normal - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
}

TEST(InitialState, IsTakenAtEveryNodeOrAtThoseNamed) {
  const fe::Model all = build("initialVelocity", {{"velocity", formulas({"-Y", "X", "0"})}});
  EXPECT_EQ(all.initial_velocity.row(26), Eigen::RowVector3d(-1, 1, 0));
  EXPECT_EQ(all.initial_displacement.rows(), 0);
  const fe::Model some =
      build("initialDisplacement", {{"indices", nodes({2})}, {"displacement", std::vector<double>{1, 2, 3}}});
  EXPECT_EQ(some.initial_displacement.row(2), Eigen::RowVector3d(1, 2, 3));
  EXPECT_EQ(some.initial_displacement.row(1), Eigen::RowVector3d(0, 0, 0));
}

}  // namespace
}  // namespace msml::test
