// SPDX-License-Identifier: GPL-3.0-or-later
// What arc length does not go with is refused before anything is meshed, by its name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

constexpr const char* arc = R"(<solver timeIntegration="static" arcLength="true"/>)";
constexpr const char* pull = R"(<forceConstraint indices="${i}" force="1 0 0"/>)";

/// Faults of a scene with a load and these constraints beside it.
std::string beside(const std::string& constraint) {
  return faults(Parts{.solver = arc, .constraint = pull + constraint});
}

TEST(ArcLanguage, SpringsDampersAndPressuresGoWithIt) {
  for (const char* sound :
       {R"(<spring first="0" second="7" stiffness="1" restLength="X"/>)",
        R"(<springToPoint indices="${i}" point="0 0 9" stiffness="1" damping="1"/>)",
        R"(<springMeshToFixed stiffness="1" fixedPoints="0 0 9" movingPoints="0 0 0"/>)",
        R"(<surfacePressure indices="${i}" pressure="1" follower="true"/>)",
        R"(<supportingMesh filename="${b}" youngModulus="1" poissonRatio="0"/>)",
        R"(<roller indices="${i}" normal="0 -2 0"/>)", R"(<initialDisplacement displacement="X 0 0"/>)"})
    EXPECT_EQ(beside(sound), "") << sound;
}

TEST(ArcLanguage, NothingChangesWithTime) {
  for (const char* timed : {R"(<spring first="0" second="7" stiffness="1+t"/>)",
                            R"(<springToPoint indices="${i}" point="0 0 9" stiffness="t"/>)",
                            R"(<springMeshToFixed stiffness="1+t" fixedPoints="0 0 9" movingPoints="0 0 0"/>)",
                            R"(<surfacePressure indices="${i}" pressure="t"/>)", R"(<bodyForce force="0 t 0"/>)",
                            R"(<displacementConstraint indices="${i}" displacement="t 0 0"/>)"})
    EXPECT_THAT(beside(timed), HasSubstr("depends on t, but arcLength follows the load and knows no time")) << timed;
  for (const char* tabled : {R"(<spring first="0" second="7" stiffness="1" table="0 1 1 2"/>)",
                             R"(<surfacePressure indices="${i}" pressure="1" table="0 1 1 2"/>)"})
    EXPECT_THAT(beside(tabled), HasSubstr("table changes with time, but arcLength follows the load")) << tabled;
  EXPECT_THAT(faults(Parts{.solver = arc, .step = R"(<step gravity="0 0 -t"/>)"}),
              HasSubstr("s.xml:12: step: gravity = -t depends on t"));
  EXPECT_THAT(faults(Parts{.solver = arc, .step = R"(<step gravity="0 0 -1" table="0 1 1 2"/>)"}),
              HasSubstr("s.xml:12: step: table changes with time"));
}

TEST(ArcLanguage, SupportsStayAndPlanesAreNotAskew) {
  EXPECT_THAT(beside(R"(<displacementConstraint indices="${i}" displacement="X 0 0"/>)"),
              HasSubstr("moves supports, but arcLength follows loads alone"));
  EXPECT_EQ(beside(R"(<displacementConstraint indices="${i}" displacement="X 0 0" components="y z"/>)"), "");
  EXPECT_THAT(beside(R"(<symmetryPlane indices="${i}" normal="1 1 0"/>)"),
              HasSubstr("symmetryPlane: its plane is askew, which arcLength does not follow"));
}

TEST(ArcLanguage, ItIteratesByItself) {
  const auto with = [](const std::string& attribute) {
    return Parts{.solver = R"(<solver timeIntegration="static" arcLength="true" )" + attribute + "/>",
                 .constraint = pull};
  };
  EXPECT_THAT(faults(with(R"(newtonIterations="1")")), HasSubstr("newtonIterations = 1 does not go with arcLength"));
  EXPECT_EQ(warnings(with(R"(newtonIterations="9" tolerance="1e-6" loadSteps="3")")), "");
  for (const char* idle : {R"(linearSolver="CG")", R"(linearSolver="CG" preconditioner="jacobi")",
                           R"(lineSearch="false")", R"(definiteness="never")"})
    EXPECT_THAT(warnings(with(idle)), HasSubstr("means nothing here: it needs")) << idle;
}

TEST(ArcLanguage, EachStepHasALoad) {
  const std::string two = R"(<step name="one" gravity="0 0 0"/><step name="two" gravity="0 0 0"/>)";
  const Parts parts{
      .solver = arc, .constraint = R"(<forceConstraint indices="${i}" force="1 0 0" forStep="one"/>)", .step = two};
  EXPECT_EQ(faults(parts),
            "s.xml:12: step: arcLength scales the loads, but there is none in this step: give it one, or "
            "take arcLength=\"false\"");
}

}  // namespace
}  // namespace msml
