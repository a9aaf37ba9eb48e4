// SPDX-License-Identifier: GPL-3.0-or-later
// What has no meaning is refused before anything is meshed, expressions and fields or not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

std::string of_region(const std::string& region, const std::string& mesh = R"(<linearTet mesh="${b}"/>)") {
  return faults(Parts{.mesh = mesh, .region = region});
}
std::string of_constraint(const std::string& constraint) { return faults(Parts{.constraint = constraint}); }
std::string of_output(const std::string& output) { return faults(Parts{.output = output}); }

TEST(CombinationLanguage, LawsOfExpressionsAreCheckedAsFarAsTheseDoNotMatter) {
  EXPECT_THAT(of_region(R"(<ogdenMaterial mu="4+X" alpha="2 -2" bulkModulus="9"/>)"),
              HasSubstr("s.xml:4: ogdenMaterial: mu has 1 numbers and alpha has 2"));
  EXPECT_THAT(of_region(R"(<reducedPolynomialMaterial c="X 1 1 1 1 1 1 1 1 1 1" bulkModulus="9"/>)"),
              HasSubstr("s.xml:4: reducedPolynomialMaterial: c has 11 numbers"));
  EXPECT_THAT(of_region(R"(<mooneyRivlinMaterial c1="1+X"/>)"), HasSubstr("mooneyRivlinMaterial needs bulkModulus"));
  EXPECT_THAT(of_region(R"(<stVenantKirchhoffMaterial youngModulus="1+X" poissonRatio="0.3"/>)",
                        R"(<linearTet mesh="${b}" formulation="fbar"/>)"),
              HasSubstr("s.xml:4: region 'region1': stVenantKirchhoffMaterial has no volumetric part"));
  EXPECT_THAT(of_region(R"(<neoHookeanMaterial youngModulus="1+X" incompressible="true"/>)"),
              HasSubstr("s.xml:4: region 'region1': neoHookeanMaterial is incompressible"));
}

TEST(CombinationLanguage, LawsThatSomePlaceMayAllowAreLeftToTheRun) {
  EXPECT_EQ(of_region(R"(<linearElasticMaterial youngModulus="X - 5" poissonRatio="0.2 + X"/>)"), "");
  EXPECT_EQ(of_region(R"(<ogdenMaterial mu="X, -4*Y" alpha="2 -2" bulkModulus="9"/>)"), "");
  EXPECT_EQ(of_region(R"(<mooneyRivlinMaterial c1="X" c2="-7" bulkModulus="1e3*X"/>)"), "");
  EXPECT_EQ(of_region(R"(<transverselyIsotropicMaterial youngModulus="1" poissonRatio="0.3" k1="1" fiber="X Y 1"/>)"),
            "");
}

TEST(CombinationLanguage, ADirectionIsThreeNumbersOrAName) {
  const auto of_fiber = [](const std::string& fiber) {
    return of_region(R"(<guccioneMaterial C="1" bf="1" bt="1" bfs="1" bulkModulus="9" fiber=")" + fiber + "\"/>");
  };
  for (const char* sound : {"1 0 0", "{1, 0, 0}", "fibres", "X", "my fibres", "X, Y - 1, 2"})
    EXPECT_EQ(of_fiber(sound), "");
  EXPECT_THAT(of_fiber("1 0"), HasSubstr("s.xml:4: guccioneMaterial: fiber = '1 0' has 2 numbers; a direction has 3"));
  EXPECT_THAT(of_fiber("1,0,0,0"), HasSubstr("has 4 numbers"));
  EXPECT_THAT(of_fiber("1, 0, sin("), HasSubstr("'sin('"));
}

TEST(CombinationLanguage, FibresOfAPlateInPlaneStressAreNotOblique) {
  const auto said = [](const std::string& fibre) {
    return faults({.mesh = R"(<linearTriangle mesh="${b}" plane="stress"/>)",
                   .region = "<guccioneMaterial C=\"1\" bf=\"2\" bt=\"1\" bfs=\"1\" bulkModulus=\"9\" fiber=\"" +
                             fibre + "\"/>"});
  };
  EXPECT_EQ(said("1 1 0"), "");
  EXPECT_EQ(said("0 0 1"), "");
  EXPECT_THAT(said("1 0 1"), HasSubstr("fibres of guccioneMaterial are oblique to the plane"));
}

TEST(CombinationLanguage, ListsInPlaceAreCounted) {
  EXPECT_THAT(of_constraint(R"(<springMeshToFixed stiffness="1" fixedPoints="0 0 0 1 1 1" movingPoints="0 0 0"/>)"),
              HasSubstr("s.xml:6: springMeshToFixed: movingPoints has 1 point, but fixedPoints 2"));
  EXPECT_EQ(of_constraint(R"(<forceConstraint indices="0 1" force="1 0 0 2 0 0"/>)"), "");
  EXPECT_THAT(of_constraint(R"(<forceConstraint indices="0 1 2" force="1 0 0 2 0 0"/>)"),
              HasSubstr("s.xml:6: forceConstraint: force has 6 numbers; allowed are 3, or 3 for each of the 3 nodes"));
  EXPECT_EQ(of_constraint(R"(<forceConstraint indices="${i}" force="1 0 0 2 0 0"/>)"), "");  // the run knows how many
  EXPECT_THAT(of_constraint(R"(<initialDisplacement displacement="1 0 0 2 0 0"/>)"),
              HasSubstr("initialDisplacement: displacement has 6 numbers; without indices"));
  EXPECT_THAT(of_constraint(R"(<displacementConstraint indices="${i}" displacement="X 0 0 2 0 0"/>)"),
              HasSubstr("has expressions in a list of one vector per node"));
  EXPECT_THAT(of_constraint(R"(<surfacePressure indices="0 1 2" pressure="1 2"/>)"),
              HasSubstr("surfacePressure: pressure has 2 numbers; allowed are 1, 3 (a traction vector) where indices"));
  EXPECT_THAT(of_constraint(R"(<fixedConstraint indices="4 1 4"/>)"), HasSubstr("indices lists node 4 twice"));
}

TEST(CombinationLanguage, OutputsFitTheBody) {
  EXPECT_THAT(of_output(R"(<probe id="p" indices="${i}" field="stress"/>)"),
              HasSubstr("s.xml:8: probe: field stress is given at elements; a probe at nodes takes stress_nodal"));
  EXPECT_EQ(of_output(R"(<probe id="p" indices="${i}" field="stress_nodal"/>)"), "");
  const std::string pressure = R"(<probe id="p" indices="${i}" field="pressure"/>)";
  EXPECT_THAT(of_output(pressure), HasSubstr("field pressure is given at elements"));
  EXPECT_EQ(faults(Parts{.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)", .output = pressure}), "");
  EXPECT_THAT(of_output(R"(<probe id="p" point="0 0 0" field="value"/>)"),
              HasSubstr("probe: field: value is of scalar"));
  const std::string heat = R"(<diffusionMaterial coefficient="1 + X"/>)";
  EXPECT_EQ(faults(Parts{.region = heat, .output = R"(<result id="r" fields="value stress strain_nodal"/>)"}), "");
  EXPECT_THAT(faults(Parts{.region = heat, .output = R"(<probe id="p" point="0 0 0"/>)"}),
              HasSubstr("s.xml:8: probe: field: displacement is 0 where the unknown is a number"));
  EXPECT_THAT(faults(Parts{.region = heat, .output = R"(<section id="s" point="0 0 0" normal="1 0 0"/>)"}),
              HasSubstr("s.xml:8: section: a scalar problem has no forces"));
}

TEST(CombinationLanguage, ParticlesHaveNoInside) {
  const Parts particles{.mesh = R"(<particles mesh="${b}"/>)", .region = R"(<pointMass mass="1"/>)"};
  const auto with = [&](const std::string& constraint, const std::string& output) {
    Parts parts = particles;
    parts.constraint = constraint;
    parts.output = output;
    return faults(parts);
  };
  EXPECT_EQ(with(R"(<forceConstraint indices="${i}" force="1 0 0"/>)", R"(<result id="r"/>)"), "");
  for (const char* load : {R"(<bodyForce force="1 0 0"/>)", R"(<surfacePressure indices="${i}" pressure="1"/>)",
                           R"(<surfaceTraction indices="${i}" traction="1 0 0"/>)"})
    EXPECT_THAT(with(load, ""), HasSubstr("acts on elements, which particles do not have"));
  EXPECT_THAT(with("", R"(<probe id="p" point="0 0 0"/>)"), HasSubstr("s.xml:8: probe: particles have no inside"));
  EXPECT_THAT(with("", R"(<volume id="v"/>)"), HasSubstr("s.xml:8: volume: particles have no volume"));
  EXPECT_THAT(faults(Parts{.mesh = R"(<particles/>)", .region = R"(<pointMass mass="1"/>)"}),
              HasSubstr("s.xml:2: particles: needs either mesh or points"));
  EXPECT_THAT(faults(Parts{.mesh = particles.mesh, .region = R"(<pointMass mass="1"/><prony g="0.5" tau="1"/>)"}),
              HasSubstr("s.xml:4: prony: has no meaning for particles"));
}

TEST(CombinationLanguage, ArcLengthNeedsALoad) {
  const std::string solver = R"(<solver timeIntegration="static" arcLength="true"/>)";
  const auto with = [&](const std::string& constraint) {
    return faults(Parts{.solver = solver, .constraint = constraint});
  };
  EXPECT_THAT(with(R"(<forceConstraint indices="${i}" force="0 0 0"/>)"),
              HasSubstr("s.xml:10: solver: arcLength scales the loads, but there is none"));
  EXPECT_EQ(with(R"(<forceConstraint indices="${i}" force="0 0 X"/>)"), "");
  const std::string hold = R"(<fixedConstraint indices="${i}"/>)";
  EXPECT_EQ(faults(Parts{.solver = solver, .constraint = hold, .step = R"(<step/>)"}), "");  // earth's gravity
  EXPECT_EQ(with(R"(<forceConstrain indices="${i}" force="1 0 0"/>)").find("arcLength"), std::string::npos);
}

TEST(CombinationLanguage, SolversDoWhatTheyAreAskedOrAreRefused) {
  EXPECT_THAT(faults(Parts{.solver = R"(<solver timeIntegration="centralDifference" mass="full"/>)"}),
              HasSubstr("s.xml:10: solver: mass=\"full\" does not go with the explicit timeIntegration"));
  EXPECT_EQ(faults(Parts{.solver = R"(<solver timeIntegration="centralDifference"/>)"}), "");
  const std::string multigrid = R"(<solver timeIntegration="static" linearSolver="CG" preconditioner="multigrid"/>)";
  EXPECT_EQ(faults(Parts{.solver = multigrid}), "");
  EXPECT_THAT(faults(Parts{.mesh = R"(<linearTriangle mesh="${b}"/>)", .solver = multigrid}),
              HasSubstr("s.xml:10: preconditioner=\"multigrid\" is for displacements of tetrahedra"));
}

/// What is wrong with the start of an incompressible body.
std::string start(const std::string& tag, const std::string& value, const std::string& integrator = "Newmark",
                  const std::string& more = "") {
  return faults(Parts{.mesh = R"(<quadraticTet mesh="${b}" formulation="mixed"/>)",
                      .region = R"(<mooneyRivlinMaterial c1="1" incompressible="true"/>)",
                      .solver = "<solver timeIntegration=\"" + integrator + "\"/>",
                      .constraint = "<initial" + tag + (tag == "Velocity" ? " velocity=\"" : " displacement=\"") +
                                    value + "\"/>" + more});
}

TEST(CombinationLanguage, AnIncompressibleBodyStartsWithoutChangingItsVolume) {
  EXPECT_EQ(start("Velocity", "1 2 3"), "");
  EXPECT_EQ(start("Velocity", "Y -X 0"), "");       // a rotation
  EXPECT_EQ(start("Velocity", "2*X -Y -Z+1"), "");  // a stretch
  EXPECT_EQ(start("Velocity", "X*Z -Y*Z 7"), "");
  EXPECT_EQ(start("Velocity", "100*Y+sin(3*Z) cos(X) exp(-X*X)"), "");
  EXPECT_THAT(start("Velocity", "X Y 0"), HasSubstr("s.xml:6: initialVelocity: velocity has the divergence 2 at"));
  EXPECT_THAT(start("Velocity", "X^2 0 0"), HasSubstr("s.xml:6: initialVelocity: velocity has the divergence"));
  EXPECT_THAT(start("Velocity", "sqrt(X)+Y 0 0"), HasSubstr("velocity has the divergence"));  // where it is defined
  EXPECT_EQ(start("Velocity", "X^2 0 0", "Newmark", R"(<initialVelocity velocity="0 0 0"/>)"), "");
}

TEST(CombinationLanguage, AnIncompressibleBodyStartsFromTheVolumeThatItHas) {
  EXPECT_EQ(start("Displacement", "5 2 3"), "");
  EXPECT_EQ(start("Displacement", "0.3*Y+sin(Z) 0.1*Z 0"), "");
  EXPECT_EQ(start("Displacement", "-0.5*X-0.8660*Y 0.8660*X-0.5*Y 0-0*Z"), "");  // rounded: the run takes care of it
  EXPECT_EQ(start("Displacement", "X*cos(Z)-Y*sin(Z)-X X*sin(Z)+Y*cos(Z)-Y 0"), "");
  EXPECT_THAT(start("Displacement", "0.1*X 0 0"),
              HasSubstr("s.xml:6: initialDisplacement: displacement has det F - 1 = 0.1 at"));
  EXPECT_THAT(start("Displacement", "sin(Z)-X/2 0.1*Y*Y 0"), HasSubstr("displacement has det F - 1"));
  EXPECT_EQ(start("Displacement", "0.1*X 0 0", "static"), "");  // a first guess
}

TEST(CombinationLanguage, SupportingMeshesActInAllSteps) {
  EXPECT_THAT(faults(Parts{.constraint = R"(<supportingMesh filename="${b}" youngModulus="1" poissonRatio="0" )"
                                         R"(forStep="one"/>)",
                           .step = R"(<step name="one" gravity="0 0 0"/><step name="two" gravity="0 0 0"/>)"}),
              HasSubstr("s.xml:6: supportingMesh: forStep = 'one': it acts in all steps"));
}

}  // namespace
}  // namespace msml
