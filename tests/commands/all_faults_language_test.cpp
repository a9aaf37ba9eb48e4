// SPDX-License-Identifier: GPL-3.0-or-later
// All faults of a scene at once: values, names, counts, combinations, conditions, outputs and the solver in one run,
// and no fault that only follows from another.
#include <gtest/gtest.h>

#include <ostream>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

/// A scene with several faults, and how the line of each begins.
struct Case {
  const char* words;
  Parts parts;
  std::vector<std::string> faults;
};

// GoogleTest prints it where a test fails.
void PrintTo(const Case& c, std::ostream* out) { *out << c.words; }

std::vector<Case> cases_1() {
  return {
      {"a value, a law and a field",
       {.mesh = R"(<linearTet mesh="${b}" formulation="fbar"/>)",
        .region = R"(<stVenantKirchhoffMaterial youngModulus="-1" poissonRatio="0.3"/>)",
        .output = R"(<result id="r" fields="value"/>)"},
       {R"(4: youngModulus = -1 is not > 0)",
        R"(4: region 'region1': stVenantKirchhoffMaterial has no volumetric part)",
        R"(8: result: fields: value is of scalar problems)"}},
      {"the name of a law, the solver and a count",
       {.region = R"(<neoHokeanMaterial youngModulus="1" poissonRatio="0.3"/>)",
        .solver = R"(<solver timeIntegration="quasiStatic" arcLength="true"/>)",
        .constraint = R"(<springMeshToFixed stiffness="1" fixedPoints="0 0 0 1 1 1" movingPoints="0 0 0"/>)"},
       {R"(4: unknown tag neoHokeanMaterial inside region (did you mean 'neoHookeanMaterial'?))",
        R"(6: springMeshToFixed: movingPoints has 1 point, but fixedPoints 2)",
        R"(10: arcLength follows static equilibria)"}},
      {"the name of an attribute, a condition and an output",
       {.solver = R"(<solver timeIntegratoin="static"/>)",
        .constraint = R"(<spring first="3" second="3" stiffness="1"/>)",
        .output = R"(<probe id="p" indices="${i}" field="stress"/>)"},
       {R"(6: spring: first and second are the same node, 3)", R"(8: probe: field stress is given at elements)",
        R"(10: solver has no attribute timeIntegratoin)"}},
      {"an attribute of other elements, a value and an output",
       {.mesh = R"(<linearTet mesh="${b}" plane="stress"/>)",
        .region = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0.7"/>)",
        .output = R"(<section id="s" point="0 0 0" normal="0 0 0"/>)"},
       {R"(2: linearTet has no attribute plane)", R"(4: poissonRatio = 0.7 is not in (-1, 0.5))",
        R"(8: section: normal has no direction)"}},
      {"a law, a step and a condition",
       {.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
        .region = R"(<stVenantKirchhoffMaterial youngModulus="1" poissonRatio="0.3"/>)",
        .constraint = R"(<initialVelocity velocity="1 0 0"/>)",
        .step = R"(<step dt="-1" gravity="0 0 0"/>)"},
       {R"(4: region 'region1': stVenantKirchhoffMaterial has no volumetric part)",
        R"(6: initialVelocity: has no meaning with timeIntegration="static")", R"(12: dt = -1 is not > 0)"}},
      {"a condition, an output and an integrator of solids in a scalar problem",
       {.region = R"(<diffusionMaterial coefficient="1"/>)",
        .solver = R"(<solver timeIntegration="Newmark"/>)",
        .constraint = R"(<fixedConstraint indices="${i}"/>)",
        .output = R"(<result id="r" fields="vonMises"/>)"},
       {R"(6: fixedConstraint: is for displacements)",
        R"(8: result: fields: vonMises is of displacements, but the unknown is a number)",
        R"(10: a scalar problem (diffusionMaterial) is stationary)"}},
      {"a condition, an output and a solver of space in the plane",
       {.mesh = R"(<linearTriangle mesh="${b}"/>)",
        .solver = R"(<solver timeIntegration="static" linearSolver="CG" preconditioner="multigrid"/>)",
        .constraint = R"(<symmetryPlane indices="${i}" normal="1 0 1"/>)",
        .output = R"(<section id="s" point="0 0 0" normal="0 0 1"/>)"},
       {R"(6: symmetryPlane: normal: entry 3 = 1 is along z)", R"(8: section: the normal (0, 0, 1) leaves the plane)",
        R"(10: preconditioner="multigrid" is for displacements of tetrahedra, but the elements are tri3)"}},
      {"a mass matrix, a step and a count of expressions",
       {.region = R"(<ogdenMaterial mu="400+X" alpha="2 -2" bulkModulus="9"/>)",
        .solver = R"(<solver timeIntegration="centralDifference" mass="full"/>)",
        .step = R"(<step dt="0" gravity="0 0 0"/>)"},
       {R"(4: ogdenMaterial: mu has 1 numbers and alpha has 2)",
        R"(10: solver: mass="full" does not go with the explicit timeIntegration="centralDifference")",
        R"(12: dt = 0 is not > 0)"}},
      {"a value, a load and an output of particles",
       {.mesh = R"(<particles mesh="${b}"/>)",
        .region = R"(<pointMass mass="-1"/>)",
        .constraint = R"(<bodyForce force="1 0 0"/>)",
        .output = R"(<result id="r" fields="stress"/>)"},
       {R"(4: mass = -1 is not > 0)", R"(6: bodyForce: acts on elements, which particles do not have)",
        R"(8: result: fields: stress is of elements)"}},
  };
}

std::vector<Case> cases_2() {
  return {
      {"an incompressible law, a condition and the control of steps",
       {.region = R"(<mooneyRivlinMaterial c1="1" incompressible="true"/>)",
        .solver = R"(<solver timeIntegration="quasiStatic" adaptiveStep="true" arcLength="true"/>)",
        .constraint = R"(<fixedValue indices="${i}" value="1"/>)"},
       {R"(4: region 'region1': mooneyRivlinMaterial is incompressible)", R"(6: fixedValue: is for scalar problems)",
        R"(10: adaptiveStep = true does not go with arcLength)", R"(10: arcLength follows static equilibria)"}},
      {"an initial velocity, a linear solver and a field",
       {.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
        .region = R"(<mooneyRivlinMaterial c1="1" incompressible="true"/>)",
        .solver = R"(<solver timeIntegration="Newmark" linearSolver="CG"/>)",
        .constraint = R"(<initialVelocity velocity="X 2*Y -Z"/>)",
        .output = R"(<result id="r" fields="strss"/>)"},
       {R"(6: initialVelocity: velocity has the divergence 2)", R"(8: fields = strss is not one of)",
        R"(10: linearSolver="CG")"}},
      {"a direction, an expression and a place",
       {.region = R"(<transverselyIsotropicMaterial youngModulus="1 +" poissonRatio="0.3" k1="1" fiber="1 0"/>)",
        .output = R"(<probe id="p" field="stress"/>)"},
       {R"(4: youngModulus = 1 +)", R"(4: transverselyIsotropicMaterial: fiber = '1 0' has 2 numbers)",
        R"(8: probe: needs one of point, along and indices)"}},
      {"relaxation and a count of forces",
       {.region = R"(<neoHookeanMaterial youngModulus="1" poissonRatio="0.3"/><prony g="0.1 0.2" tau="1"/>)",
        .solver = R"(<solver timeIntegration="static" arcLength="true"/>)",
        .constraint = R"(<forceConstraint indices="0 1 2 3" force="1 0 0 2 0 0"/>)"},
       {R"(4: prony: g has 2 numbers and tau 1)", R"(4: region 'region1': prony needs time)",
        R"(6: forceConstraint: force has 6 numbers; allowed are 3, or 3 for each of the 4 nodes in indices (12))"}},
      {"a reference, a formulation and an integrator",
       {.mesh = R"(<quadraticTet mesh="${b}" formulation="singleRotation"/>)",
        .region = R"(<neoHookeanMaterial youngModulus="1" poissonRatio="0.3"/>)",
        .solver = R"(<solver timeIntegration="forwardEuler"/>)",
        .constraint = R"(<fixedConstraint indices="${nope}"/>)"},
       {R"(4: region 'region1': formulation = singleRotation is for linearElasticMaterial)",
        R"(6: ${nope} names no variable, task or output)",
        R"(10: solver: forwardEuler is unstable at any dt without damping)"}},
      {"the name of the solver, a law and a number",
       {.mesh = R"(<linearTet mesh="${b}" formulation="fbar"/>)",
        .region = R"(<stVenantKirchhoffMaterial youngModulus="1" poissonRatio="0.3"/>)",
        .solver = R"(<solvr timeIntegration="static"/>)",
        .output = R"(<result id="r" every="0"/>)"},
       {R"(4: region 'region1': stVenantKirchhoffMaterial has no volumetric part)", R"(8: every = 0 is not in)",
        R"(10: unknown tag solvr)"}},
      {"a direction, a quadrature and the name of a file",
       {.mesh = R"(<quadraticTet mesh="${b}" formulation="singleRotation" quadrature="8"/>)",
        .constraint = R"(<symmetryPlane indices="${i}" normal="0 0 0"/>)",
        .output = R"(<energies id=""/>)"},
       {R"(2: quadrature = 8 needs formulation = standard or mixed, but it is singleRotation)",
        R"(6: normal: 0 0 0 has no direction)", R"(8: the id of energies is empty)"}},
      {"a tolerance, a support and a field",
       {.solver = R"(<solver timeIntegration="static" arcLength="true" tolerance="2"/>)",
        .constraint = R"(<displacementConstraint indices="${i}" displacement="0 0 1"/>)",
        .step = R"(<step gravity="0 0 -1"/>)",
        .output = R"(<result id="r" fields="vonMise"/>)"},
       {R"(6: displacementConstraint: moves supports, but arcLength follows loads alone)",
        R"(8: fields = vonMise is not one of)", R"(10: tolerance = 2 is not in (0, 1))"}},
  };
}

std::vector<Case> cases_3() {
  return {
      {"two outputs of one name, a law and a damping",
       {.region = R"(<mooneyRivlinMaterial c1="1" incompressible="true" inversion="clamped"/>)",
        .solver = R"(<solver timeIntegration="Newmark" dampingRayleighRatioMass="-1"/>)",
        .output = R"(<result id="r"/><energies id="r"/>)"},
       {R"(4: mooneyRivlinMaterial: inversion = "clamped" and incompressible = "true" exclude each other)",
        R"(8: the name r is taken)", R"(10: dampingRayleighRatioMass = -1 is not >= 0)"}},
      {"an embedded mesh, a formulation and a gravity",
       {.mesh = R"(<linearTriangle mesh="${b}" formulation="mixd"/>)",
        .constraint = R"(<supportingMesh filename="${b}" youngModulus="1" poissonRatio="0"/>)",
        .step = R"(<step gravity="0 0 -9"/>)"},
       {R"(2: formulation = mixd is not one of standard)", R"(6: supportingMesh: needs a main mesh of tetrahedra)",
        R"(12: step: gravity has a part along z)"}},
      {"a missing attribute, a missing modulus and an integrator",
       {.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
        .region = R"(<mooneyRivlinMaterial c1="1" />)",
        .solver = R"(<solver timeIntegration="centralDifference"/>)",
        .constraint = R"(<forceConstraint indices="${i}"/>)"},
       {R"(4: mooneyRivlinMaterial needs bulkModulus)", R"(6: forceConstraint needs the attribute force)",
        R"(10: timeIntegration="centralDifference" is explicit)"}},
      {"a start, numbers of Newmark and a count",
       {.solver = R"(<solver timeIntegration="Newmark" gamma="0.4"/>)",
        .constraint = R"(<initialVelocity velocity="t 0 0"/>)",
        .output = R"(<probe id="p" point="0 0" field="J"/>)"},
       {R"(6: velocity: 't' depends on t)", R"(8: point has 2 values, but needs 3)",
        R"(10: Newmark with beta = 0.25, gamma = 0.4)"}},
      {"a parameter, a place of a tag and the control of steps",
       {.region = R"(<holzapfelGasserOgdenMaterial mu="1" k1="1" k2="1" kappa="0.4" fiber="1 0 0" bulkModulus="9"/>)",
        .solver = R"(<solver timeIntegration="symplecticEuler" adaptiveStep="true"/>)",
        .constraint = R"(<linearTet mesh="${b}"/>)"},
       {R"(4: kappa = 0.4 is not in [0, 0.3333333333333333])", R"(6: linearTet may not stand inside constraint)",
        R"(10: adaptiveStep = true does not go with the explicit timeIntegration)"}},
      {"a field twice, an axis and a preconditioner",
       {.mesh = R"(<linearTriangle mesh="${b}"/>)",
        .region =
            R"(<linearElasticMaterial youngModulus="1" poissonRatio="0" fields="youngModulus=E youngModulus=G"/>)",
        .solver = R"(<solver timeIntegration="static" linearSolver="CG" preconditioner="ilu"/>)",
        .constraint = R"(<fixedConstraint indices="${i}" components="z"/>)"},
       {R"(4: linearElasticMaterial: fields names youngModulus twice)",
        R"(6: fixedConstraint: components = z holds nothing)", R"(10: preconditioner: 'ilu' is not one of)"}},
      {"a traction, powers and a count",
       {.region = R"(<polynomialMaterial terms="0 0 1+X" bulkModulus="9"/>)",
        .constraint = R"(<surfacePressure indices="${i}" pressure="0 0 1" follower="true"/>)",
        .output = R"(<section id="s" point="0 0" normal="1 0 0"/>)"},
       {R"(4: polynomialMaterial: terms holds the powers 0 0)",
        R"(6: surfacePressure: follower = true has no meaning for a traction vector)",
        R"(8: point has 2 values, but needs 3)"}},
      {"an energy of volume, a spring and a density",
       {.region =
            R"(<neoHookeanMaterial youngModulus="1+X" poissonRatio="0.3" volumetric="J1"/><mass massDensity="0"/>)",
        .constraint = R"(<spring first="3" second="4" stiffness="-1"/>)"},
       {R"(4: massDensity = 0 is not > 0)", R"(4: neoHookeanMaterial: volumetric = "J1" has no place in form = "log")",
        R"(6: stiffness = -1 is not > 0)"}},
  };
}

/// Tags that have several faults each.
std::vector<Case> cases_4() {
  return {
      {"two in a law and two in a condition",
       {.mesh = R"(<linearLine mesh="${b}"/>)",
        .region = R"(<mooneyRivlinMaterial c1="-1" incompressible="true" bulkModulus="9"/>)",
        .constraint = R"(<surfaceTraction indices="${i}" traction="1 2 3"/>)"},
       {R"(4: mooneyRivlinMaterial: incompressible = "true" leaves no room for bulkModulus)",
        R"(4: mooneyRivlinMaterial: the shear modulus at rest, 2 (c1 + c2) = -2, is not > 0)",
        R"(6: surfaceTraction: traction: entry 2 = 2 is along y)",
        R"(6: surfaceTraction: traction: entry 3 = 3 is along z)"}},
      {"three in a law and three in a condition",
       {.mesh = R"(<linearTriangle mesh="${b}"/>)",
        .region = R"(<neoHookeanMaterial youngModulus="1" poissonRatio="0.3" volumetric="J1" incompressible="true" )"
                  R"(inversion="clamped"/>)",
        .constraint = R"(<forceConstraint indices="0 1 1" force="1 0 3 2 0 0"/>)"},
       {R"(4: neoHookeanMaterial: incompressible = "true" leaves no room for poissonRatio)",
        R"(4: neoHookeanMaterial: inversion = "clamped" and incompressible = "true" exclude)",
        R"(4: neoHookeanMaterial: volumetric = "J1" has no place in form = "log")",
        R"(6: forceConstraint: force: entry 3 = 3 is along z)",
        R"(6: forceConstraint: force has 6 numbers; allowed are 3, or 3 for each of the 3 nodes)",
        R"(6: forceConstraint: indices lists node 1 twice)"}},
      {"directions, volume, terms of relaxation and gravity along two axes",
       {.mesh = R"(<linearLine mesh="${b}"/>)",
        .region = R"(<holzapfelGasserOgdenMaterial mu="1" k1="1" k2="1" fiber="0 0 0" fiber2="0,0,0"/>)"
                  R"(<prony g="0.6 0.6" tau="1"/>)",
        .step = R"(<step gravity="0 1 2"/>)"},
       {R"(4: holzapfelGasserOgdenMaterial needs bulkModulus)",
        R"(4: holzapfelGasserOgdenMaterial: fiber = '0 0 0' has no direction)",
        R"(4: holzapfelGasserOgdenMaterial: fiber2 = '0,0,0' has no direction)",
        R"(4: prony: g has 2 numbers and tau 1)", R"(4: prony: the sum of g = 1.2 is not < 1)",
        R"(12: step: gravity has a part along y)", R"(12: step: gravity has a part along z)"}},
      {"fields, pairs of numbers and powers",
       {.region = R"(<ogdenMaterial mu="1 1" alpha="-1 -2" fields="mu=a mu[1]=b alpha beta=c"/>)",
        .constraint = R"(<springMeshToFixed stiffness="1" fixedPoints="0 0 0 1 1 1" movingPoints="0 0 0"/>)"
                      R"(<polynomialMaterial/>)"},
       {R"(4: ogdenMaterial needs bulkModulus)", R"(4: ogdenMaterial: mu = 1 with alpha = -1)",
        R"(4: ogdenMaterial: mu = 1 with alpha = -2)", R"(4: ogdenMaterial: fields names mu[1] twice)",
        R"(4: ogdenMaterial: fields: 'alpha' is no pair)", R"(4: ogdenMaterial: fields: 'beta' is no attribute)",
        R"(6: springMeshToFixed: movingPoints has 1 point)", R"(6: polynomialMaterial may not stand inside)"}},
  };
}

std::vector<Case> cases() {
  std::vector<Case> all = cases_1();
  for (const auto& more : {cases_2(), cases_3(), cases_4()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

class AllFaultsLanguage : public testing::TestWithParam<Case> {};

TEST_P(AllFaultsLanguage, AreNamedInOneRunAtTheirLinesAndNoOthers) {
  const std::vector<Fault> found = compiled(GetParam().parts).faults;
  const std::string all = tiny::lines(found);
  EXPECT_EQ(found.size(), GetParam().faults.size()) << all;
  for (const std::string& expected : GetParam().faults)
    EXPECT_NE(("\n" + all).find("\ns.xml:" + expected), std::string::npos) << expected << "\nis not in\n" << all;
}

INSTANTIATE_TEST_SUITE_P(Of, AllFaultsLanguage, testing::ValuesIn(cases()));

}  // namespace
}  // namespace msml
