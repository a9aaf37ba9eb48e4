// SPDX-License-Identifier: GPL-3.0-or-later
// What means nothing beside the rest of a scene is warned of before anything runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

/// The warnings beside a solver with these attributes.
std::string of_solver(const std::string& attributes) {
  return warnings(Parts{.solver = "<solver " + attributes + "/>"});
}

/// The attribute has no meaning there, at the line of the solver.
std::string idle(const std::string& attribute) { return "s.xml:10: solver: " + attribute + " means nothing here"; }

TEST(IdleLanguage, ASolverWithoutIdleAttributesIsSilent) {
  EXPECT_EQ(of_solver(R"(timeIntegration="static" linearSolver="direct" loadSteps="4")"), "");
  EXPECT_EQ(of_solver(R"(timeIntegration="Newmark" spectralRadius="0.8")"), "");  // the default
  EXPECT_EQ(of_solver(R"(linearSolver="direct" preconditioner="ILU2")"), "");     // of another program
}

TEST(IdleLanguage, AttributesOfOtherIntegratorsAreNamed) {
  EXPECT_EQ(of_solver(R"(timeIntegration="Newmark" spectralRadius="0.5")"),
            "s.xml:10: solver: spectralRadius means nothing here: it needs timeIntegration=\"generalizedAlpha\". Leave "
            "it out");
  EXPECT_THAT(of_solver(R"(timeIntegration="Newmark" loadSteps="4")"), HasSubstr(idle("loadSteps")));
  EXPECT_THAT(of_solver(R"(timeIntegration="Newmark" stepTolerance="0.1")"), HasSubstr(idle("stepTolerance")));
  EXPECT_THAT(of_solver(R"(timeIntegration="static" largestLoadFactor="2")"), HasSubstr(idle("largestLoadFactor")));
  EXPECT_THAT(of_solver(R"(timeIntegration="static" dampingRayleighRatioMass="1")"),
              HasSubstr(idle("dampingRayleighRatioMass")));
  EXPECT_THAT(of_solver(R"(timeIntegration="static" mass="lumped")"), HasSubstr(idle("mass")));
  EXPECT_THAT(of_solver(R"(linearSolver="direct" preconditioner="jacobi")"), HasSubstr(idle("preconditioner")));
}

TEST(IdleLanguage, ExplicitMethodsSolveNoEquations) {
  const std::string said = of_solver(
      R"(timeIntegration="centralDifference" linearSolver="CG" newtonIterations="3" tolerance="1e-9" lineSearch="0")");
  for (const char* attribute : {"linearSolver", "newtonIterations", "tolerance", "lineSearch"})
    EXPECT_THAT(said, HasSubstr(idle(attribute)));
}

TEST(IdleLanguage, MethodsThatDampNothingLetThePressuresOfIncompressibleBodiesSwing) {
  const auto with = [](const std::string& attributes, const std::string& law = R"(incompressible="true")") {
    return warnings(Parts{.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
                          .region = "<mooneyRivlinMaterial c1=\"1\" " + law + "/>",
                          .solver = "<solver " + attributes + "/>"});
  };
  EXPECT_THAT(with(R"(timeIntegration="Newmark")"),
              HasSubstr("s.xml:10: solver: timeIntegration=\"Newmark\" lets the pressure of incompressible=\"true\" "
                        "swing"));
  EXPECT_THAT(with(R"(timeIntegration="Newmark")"), HasSubstr("generalizedAlpha or dynamicImplicitEuler"));
  EXPECT_THAT(with(R"(timeIntegration="generalizedAlpha" spectralRadius="1")"), HasSubstr("spectralRadius=\"1\" lets"));
  for (const char* damping : {R"(timeIntegration="generalizedAlpha")", R"(timeIntegration="dynamicImplicitEuler")",
                              R"(timeIntegration="Newmark" gamma="0.6" beta="0.3025")", R"(timeIntegration="static")"})
    EXPECT_EQ(with(damping), "");
  EXPECT_EQ(with(R"(timeIntegration="Newmark")", R"(bulkModulus="100")"), "");
}

TEST(IdleLanguage, FieldsOfKnownValueAreNamed) {
  const std::string said = warnings(Parts{.output = R"(<result id="r" fields="velocity fiberStretch"/>)"});
  EXPECT_THAT(said, HasSubstr("s.xml:8: result: velocity is 0 with timeIntegration=\"static\""));
  EXPECT_THAT(said, HasSubstr("s.xml:8: result: fiberStretch is 1, since no material has fibres"));
  EXPECT_EQ(warnings(Parts{.output = R"(<result id="r"/>)"}), "");  // what the scene did not ask for
}

TEST(IdleLanguage, TagsOfTheBodyAreLookedAtToo) {
  EXPECT_THAT(warnings(Parts{.constraint = R"(<spring first="0" second="1" stiffness="1" damping="1"/>)"}),
              HasSubstr("s.xml:6: spring: damping means nothing here: it needs a dynamic timeIntegration"));
  EXPECT_THAT(
      warnings(Parts{.region = R"(<neoHookeanMaterial youngModulus="1+X" poissonRatio="0.3" clampedBelow="0.2"/>)"}),
      HasSubstr("s.xml:4: neoHookeanMaterial: clampedBelow means nothing here"));
  EXPECT_THAT(
      warnings(Parts{.constraint = R"(<displacementConstraint indices="${i}" displacement="0 0 t" ramp="step"/>)"}),
      HasSubstr("s.xml:6: displacementConstraint: ramp means nothing here"));
}

TEST(IdleLanguage, WhatIsLeftOpenIsNotCalledIdle) {
  // A misspelt attribute may have been the integrator.
  EXPECT_EQ(of_solver(R"(timeIntegratoin="static" loadSteps="4" spectralRadius="0.5")"), "");
  EXPECT_EQ(of_solver(R"(timeIntegration="statc" loadSteps="4")"), "");
}

}  // namespace
}  // namespace msml
