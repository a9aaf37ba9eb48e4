// SPDX-License-Identifier: GPL-3.0-or-later
// Materials and formulations of the real language that do not go together: text in, message out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

std::string faults(const std::string& mesh, const std::string& region) {
  return faults(Parts{.mesh = mesh, .region = region});
}

constexpr const char* diffusion = R"(<diffusionMaterial coefficient="1"/>)";
constexpr const char* elastic = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0.3"/>)";
constexpr const char* relaxing =
    R"(<linearElasticMaterial youngModulus="1" poissonRatio="0.3"/><prony g="0.5" tau="1"/>)";

TEST(FormulationLanguage, LawsWithoutAVolumetricPartAreRefusedBeforeAnythingRuns) {
  const std::string law = "<stVenantKirchhoffMaterial youngModulus=\"1\" poissonRatio=\"0.3\"/>";
  EXPECT_EQ(faults("<linearTet mesh=\"${b}\"/>", law), "");
  EXPECT_NE(faults("<linearTet mesh=\"${b}\" formulation=\"fbar\"/>", law)
                .find("s.xml:4: region 'region1': stVenantKirchhoffMaterial has no volumetric part"),
            std::string::npos);
}

TEST(FormulationLanguage, IncompressibleLawsNeedAPressure) {
  const std::string law = "<neoHookeanMaterial youngModulus=\"1\" form=\"isochoric\" incompressible=\"true\"/>";
  EXPECT_EQ(faults("<quadraticTet mesh=\"${b}\" formulation=\"mixed\"/>", law), "");
  EXPECT_NE(faults("<quadraticTet mesh=\"${b}\"/>", law).find("needs a mesh with formulation=\"mixed\""),
            std::string::npos);
}

TEST(FormulationLanguage, MaterialsThatCannotBeBuiltAreRefusedBeforeAnythingRuns) {
  EXPECT_NE(faults("<linearTet mesh=\"${b}\"/>", "<neoHookeanMaterial youngModulus=\"1\"/>").find("s.xml:4: "),
            std::string::npos);
}

TEST(FormulationLanguage, DirectionsMayNameAFieldThatTheMeshWillHave) {
  EXPECT_EQ(faults(Parts{.region = R"(<transverselyIsotropicMaterial youngModulus="1" poissonRatio="0.3" k1="1" )"
                                   R"(fiber="fibres"/>)"}),
            "");
}

TEST(FormulationLanguage, QuadratureOfEightPointsIsForStandardElements) {
  EXPECT_THAT(faults(R"(<quadraticTet mesh="${b}" formulation="singleRotation" quadrature="8"/>)", elastic),
              HasSubstr("s.xml:2: quadrature = 8 needs formulation = standard or mixed, but it is singleRotation"));
}

TEST(FormulationLanguage, ASingleRotationIsForCorotatedElasticity) {
  EXPECT_THAT(faults(R"(<quadraticTet mesh="${b}" formulation="singleRotation"/>)",
                     R"(<stVenantKirchhoffMaterial youngModulus="1" poissonRatio="0.3"/>)"),
              HasSubstr("s.xml:4: region 'region1': formulation = singleRotation is for linearElasticMaterial"));
}

TEST(FormulationLanguage, ExpressionsGoWithEveryElement) {
  const std::string law = R"(<linearElasticMaterial youngModulus="1 + X" poissonRatio="0.3"/>)";
  EXPECT_EQ(faults(R"(<linearTet mesh="${b}"/>)", law), "");
  EXPECT_EQ(faults(R"(<linearTet mesh="${b}" formulation="fbar"/>)", law), "");
  EXPECT_EQ(faults(R"(<quadraticTet mesh="${b}" formulation="mixed"/>)", law), "");
  EXPECT_EQ(faults(R"(<quadraticTet mesh="${b}" formulation="singleRotation"/>)", law), "");
}

TEST(FormulationLanguage, PlaneStressIsAboutDisplacements) {
  EXPECT_THAT(faults(R"(<linearTriangle mesh="${b}" plane="stress"/>)", diffusion),
              HasSubstr("s.xml:4: region 'region1': plane=\"stress\" is about displacements"));
}

TEST(FormulationLanguage, PronyGoesWithEveryFormulation) {
  for (const char* mesh : {R"(<linearTet mesh="${b}"/>)", R"(<linearTet mesh="${b}" formulation="fbar"/>)",
                           R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
                           R"(<quadraticTet mesh="${b}" formulation="singleRotation"/>)",
                           R"(<linearTriangle mesh="${b}" plane="stress"/>)"})
    EXPECT_EQ(faults(mesh, relaxing), "") << mesh;
}

TEST(FormulationLanguage, PronyIsForStressesInTime) {
  EXPECT_THAT(faults(Parts{.region = relaxing, .solver = R"(<solver timeIntegration="static" arcLength="true"/>)"}),
              HasSubstr("prony needs time"));
  EXPECT_THAT(faults(Parts{.region = std::string(diffusion) + R"(<prony g="0.5" tau="1"/>)"}),
              HasSubstr("prony is for stresses"));
}

TEST(FormulationLanguage, ScalarProblemsAreStationary) {
  EXPECT_EQ(faults(Parts{.region = diffusion}), "");
  EXPECT_THAT(
      faults(Parts{.region = diffusion, .solver = R"(<solver timeIntegration="Newmark"/>)"}),
      HasSubstr("s.xml:10: a scalar problem (diffusionMaterial) is stationary, but timeIntegration is Newmark"));
}

TEST(FormulationLanguage, ConditionsAreOfTheUnknownOfTheLaws) {
  const std::string held = R"(<fixedConstraint indices="${i}"/>)", value = R"(<fixedValue indices="${i}" value="1"/>)";
  EXPECT_EQ(faults(Parts{.constraint = held}), "");
  EXPECT_EQ(faults(Parts{.region = diffusion, .constraint = value}), "");
  EXPECT_THAT(faults(Parts{.region = diffusion, .constraint = held}),
              HasSubstr("s.xml:6: fixedConstraint: is for displacements, but the regions have diffusionMaterial"));
  EXPECT_THAT(faults(Parts{.constraint = value}), HasSubstr("s.xml:6: fixedValue: is for scalar problems"));
  EXPECT_THAT(faults(Parts{.region = diffusion, .step = R"(<step gravity="1 0 0"/>)"}),
              HasSubstr("step: gravity has no meaning where the unknown is a number"));
}

TEST(FormulationLanguage, MixedElementsNeedEquationsAndADirectSolver) {
  const std::string mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)";
  EXPECT_THAT(faults(Parts{.mesh = mesh, .solver = R"(<solver timeIntegration="centralDifference"/>)"}),
              HasSubstr("s.xml:10: timeIntegration=\"centralDifference\" is explicit, but the pressure"));
  EXPECT_THAT(
      faults(Parts{.mesh = mesh, .solver = R"(<solver timeIntegration="static" linearSolver="CG"/>)"}),
      HasSubstr(
          "s.xml:10: linearSolver=\"CG\" (and \"GMRES\", which is taken as it) needs a positive definite matrix"));
}

TEST(FormulationLanguage, StepControlFitsTheIntegrator) {
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="quasiStatic" arcLength="true"/>)"}),
              HasSubstr("s.xml:10: arcLength follows static equilibria, but timeIntegration is quasiStatic"));
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="symplecticEuler" adaptiveStep="true"/>)"}),
              HasSubstr("s.xml:10: adaptiveStep = true does not go with the explicit timeIntegration"));
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="static" arcLength="true" adaptiveStep="true"/>)"}),
              HasSubstr("s.xml:10: adaptiveStep = true does not go with arcLength"));
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="Newmark" beta="0.1"/>)"}),
              HasSubstr("s.xml:10: Newmark with beta = 0.1"));
}

TEST(FormulationLanguage, ClampedLawsAreIsotropic) {
  EXPECT_THAT(faults(R"(<linearTet mesh="${b}"/>)", R"(<mooneyRivlinMaterial c1="1" )"
                                                    R"(incompressible="true" inversion="clamped"/>)"),
              HasSubstr("exclude each other"));
}

TEST(FormulationLanguage, ParticlesHaveMassesAndElementsHaveLaws) {
  EXPECT_THAT(faults(R"(<linearTet mesh="${b}"/>)", R"(<pointMass mass="1"/>)"),
              HasSubstr("s.xml:4: pointMass: is for a body of particles"));
  EXPECT_THAT(faults(R"(<particles mesh="${b}"/>)", elastic),
              HasSubstr("s.xml:4: linearElasticMaterial: is no law for particles"));
}

/// A plane of triangles on line 2.
Parts plane(const std::string& constraint, const std::string& stress = "strain") {
  return {.mesh = "<linearTriangle mesh=\"${b}\" plane=\"" + stress + "\"/>", .constraint = constraint};
}

TEST(FormulationLanguage, PlaneBodiesTakeNothingAcrossTheirPlane) {
  EXPECT_EQ(faults(plane(R"(<forceConstraint indices="${i}" force="1 2 0"/>)")), "");
  EXPECT_EQ(faults(plane(R"(<displacementConstraint indices="${i}" displacement="1 0 9" components="x y"/>)")), "");
  EXPECT_EQ(faults(plane(R"(<displacementConstraint indices="${i}" displacement="1 0 9"/>)")),
            "s.xml:6: displacementConstraint: displacement: entry 3 = 9 is along z, but a plane body moves along x and "
            "y alone; write 0 there");
  EXPECT_THAT(faults(plane(R"(<forceConstraint indices="${i}" force="1 0 0 1 0 2"/>)")), HasSubstr("entry 6 = 2"));
  EXPECT_THAT(faults(plane(R"(<surfaceTraction indices="${i}" traction="0 0 t"/>)")), HasSubstr("entry 3 = t"));
  EXPECT_THAT(faults(plane(R"(<surfacePressure indices="${i}" pressure="0 0 1"/>)")), HasSubstr("entry 3 = 1"));
  EXPECT_THAT(faults(Parts{.mesh = R"(<linearLine mesh="${b}"/>)", .constraint = R"(<bodyForce force="1 1 0"/>)"}),
              HasSubstr("entry 2 = 1 is along y, but a body of lines moves along x alone"));
  EXPECT_THAT(faults(Parts{.mesh = R"(<linearTriangle mesh="${b}"/>)", .step = R"(<step gravity="0 0 -9"/>)"}),
              HasSubstr("gravity has a part along z, but plane bodies move along x and y alone"));
  EXPECT_THAT(faults(plane(R"(<supportingMesh filename="${b}" youngModulus="1" poissonRatio="0"/>)")),
              HasSubstr("s.xml:6: supportingMesh: needs a main mesh of tetrahedra"));
}

TEST(FormulationLanguage, APressureThatFollowsSeesThePlateGrowThin) {
  Parts parts = plane(R"(<surfacePressure indices="${i}" pressure="1"/>)", "stress");
  EXPECT_EQ(faults(parts), "");
  parts.region = R"(<neoHookeanMaterial youngModulus="1" poissonRatio="0.3"/>)";
  EXPECT_EQ(faults(parts), "");
}

TEST(FormulationLanguage, VelocitiesNeedInertia) {
  const std::string start = R"(<initialVelocity velocity="1 0 0"/>)";
  EXPECT_THAT(faults(Parts{.constraint = start}),
              HasSubstr("s.xml:6: initialVelocity: has no meaning with timeIntegration=\"static\""));
  EXPECT_EQ(faults(Parts{.solver = R"(<solver timeIntegration="Newmark"/>)", .constraint = start}), "");
}

TEST(FormulationLanguage, ArcLengthFollowsLoadsAlone) {
  Parts parts{.solver = R"(<solver timeIntegration="static" arcLength="true"/>)",
              .constraint = R"(<displacementConstraint indices="${i}" displacement="0 0 1"/>)",
              .step = R"(<step gravity="0 0 -1"/>)"};
  EXPECT_THAT(faults(parts), HasSubstr("s.xml:6: displacementConstraint: moves supports, but arcLength follows loads"));
  parts.constraint = R"(<displacementConstraint indices="${i}" displacement="0 0 1" components="x"/>)";
  EXPECT_EQ(faults(parts), "");
}

TEST(FormulationLanguage, ForwardEulerNeedsDamping) {
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="forwardEuler"/>)"}),
              HasSubstr("s.xml:10: solver: forwardEuler is unstable at any dt without damping"));
  EXPECT_EQ(faults(Parts{.solver = R"(<solver timeIntegration="forwardEuler" dampingRayleighRatioMass="1"/>)"}), "");
  EXPECT_EQ(faults(Parts{.solver = R"(<solver timeIntegration="forwardEuler"/>)",
                         .constraint = R"(<springToPoint indices="${i}" point="0 0 0" stiffness="1" damping="1"/>)"}),
            "");
}

TEST(FormulationLanguage, ASpringNeedsTwoNodes) {
  EXPECT_EQ(faults(Parts{.constraint = R"(<spring first="3" second="3" stiffness="1"/>)"}),
            "s.xml:6: spring: first and second are the same node, 3");
  EXPECT_EQ(faults(Parts{.constraint = R"(<spring first="3" second="4" stiffness="1 + X"/>)"}), "");
  EXPECT_EQ(faults(Parts{.constraint = R"(<spring first="3" second="4" stiffness="1 + t" table="0 0 1 1"/>)"}), "");
}

TEST(FormulationLanguage, WhatMaterialsTakeFromElsewhereIsReadBeforeAnythingRuns) {
  EXPECT_THAT(faults(Parts{.region = R"(<linearElasticMaterial youngModulus="1 + t" poissonRatio="0"/>)"}),
              HasSubstr("s.xml:4: linearElasticMaterial: youngModulus = '1 + t' depends on t"));
  EXPECT_THAT(faults(Parts{.region = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0" fields="E"/>)"}),
              HasSubstr("s.xml:4: linearElasticMaterial: fields: 'E' is no pair attribute=field"));
  EXPECT_THAT(faults(Parts{.region = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0" fields="E=E"/>)"}),
              HasSubstr("fields: 'E' is no attribute that takes a number"));
  EXPECT_THAT(
      faults(Parts{.region = R"(<guccioneMaterial C="1" bf="1" bt="1" bfs="1" bulkModulus="9" fiber="X t 1"/>)"}),
      HasSubstr("s.xml:4: guccioneMaterial: fiber = 't' depends on t"));
  EXPECT_THAT(faults(Parts{.region = R"(<polynomialMaterial terms="1 X 3" bulkModulus="9"/>)"}),
              HasSubstr("the power X is no number"));
  EXPECT_THAT(faults(Parts{.region = R"(<ogdenMaterial mu="1 +" alpha="2" bulkModulus="9"/>)"}), HasSubstr("s.xml:4"));
}

}  // namespace
}  // namespace msml
