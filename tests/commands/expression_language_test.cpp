// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions that are wrong wherever and whenever they are evaluated are refused before anything is meshed; so are
// load curves that never act noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

std::string of_region(const std::string& region) { return faults(Parts{.region = region}); }
std::string of_constraint(const std::string& constraint) { return faults(Parts{.constraint = constraint}); }

TEST(ExpressionLanguage, WhatIsFiniteNowhereIsRefused) {
  EXPECT_THAT(of_constraint(R"x(<bodyForce force="0, 1/(X-X), 0"/>)x"),
              HasSubstr("s.xml:6: force: entry 2 of the list = 1/(X-X) is inf at X = "));
  EXPECT_THAT(of_constraint(R"x(<surfacePressure indices="${i}" pressure="sqrt(-1-X*X)"/>)x"),
              HasSubstr("s.xml:6: pressure: entry 1 of the list = sqrt(-1-X*X) is nan at X = "));
  EXPECT_THAT(of_constraint(R"x(<displacementConstraint indices="${i}" displacement="log(-1-t*t), 0, 0"/>)x"),
              HasSubstr("is nan at X = "));
  EXPECT_THAT(faults(Parts{.step = R"x(<step gravity="0, 0, log(-1-t*t)"/>)x"}),
              HasSubstr("s.xml:12: gravity: entry 3 of the list = log(-1-t*t) is nan at X = "));
  EXPECT_THAT(of_region(R"x(<guccioneMaterial C="1" bf="1" bt="1" bfs="1" bulkModulus="9" fiber="1, 1/(X-X), 0"/>)x"),
              HasSubstr("s.xml:4: guccioneMaterial: fiber: '1/(X-X)' is inf at X = "));
  EXPECT_EQ(of_constraint(R"(<bodyForce force="0 1/X 0"/>)"), "");
}

TEST(ExpressionLanguage, WhatIsInItsRangeNowhereIsRefused) {
  EXPECT_THAT(of_region(R"(<linearElasticMaterial youngModulus="-1-X*X" poissonRatio="0.3"/>)"),
              testing::AllOf(HasSubstr("s.xml:4: youngModulus = -1-X*X is -"), HasSubstr(", and > 0 at no place")));
  EXPECT_THAT(of_region(R"(<linearElasticMaterial youngModulus="1" poissonRatio="1+X*X"/>)"),
              HasSubstr("and in (-1, 0.5) at no place"));
  const std::string law = R"(<linearElasticMaterial youngModulus="1" poissonRatio="0.3"/>)";
  EXPECT_THAT(of_region(law + R"x(<mass massDensity="-abs(Y)"/>)x"), HasSubstr("s.xml:4: massDensity = -abs(Y) is -"));
  EXPECT_THAT(of_region(law + R"x(<prony g="0.5" tau="-exp(X)"/>)x"),
              HasSubstr("tau: entry 1 of the list = -exp(X) is -"));
  EXPECT_THAT(of_constraint(R"(<spring first="0" second="1" stiffness="-1-t"/>)"),
              HasSubstr("s.xml:6: stiffness = -1-t"));
  EXPECT_EQ(of_region(law + R"(<prony g="max(0, X - 0.5)/2" tau="1"/>)"), "");
}

TEST(ExpressionLanguage, SpringsAndPulsesAreJudgedBeforeTheRun) {
  EXPECT_THAT(of_constraint(R"(<spring first="0" second="1" stiffness="1" table="0 1 1 -2"/>)"),
              HasSubstr("s.xml:6: table: the factor -2 is not >= 0"));
  EXPECT_THAT(of_constraint(R"(<surfacePressureOnMesh mesh="${b}" indices="0" pressure="1" pulse="sin"/>)"),
              HasSubstr("s.xml:6: pulse: it is not available yet; a table or an expression"));
}

TEST(ExpressionLanguage, TablesThatEndBeforeTheyActOrBeginAfterAreNoticed) {
  const auto with = [](const std::string& table, const std::string& step = R"(forStep="two")") {
    return warnings(
        Parts{.constraint = R"(<forceConstraint indices="${i}" force="1 0 0" table=")" + table + "\" " + step + "/>",
              .step = R"(<step name="one" dt="0.5" iterations="4" gravity="0 0 0"/>)"
                      R"(<step name="two" dt="0.5" iterations="2" gravity="0 0 0"/>)"});
  };
  EXPECT_EQ(with("0 0 2.5 1"), "");
  EXPECT_EQ(with("-1 0 9 1"), "");
  EXPECT_EQ(with("0 0 1 1", ""), "");
  EXPECT_THAT(with("0 0 2 5"),
              HasSubstr("s.xml:6: forceConstraint: the times of its table, 0 to 2, lie outside of 2 to "
                        "3, when it acts: its factor is 5 all the time"));
  EXPECT_THAT(with("3 7 4 1"), HasSubstr("its factor is 7 all the time"));
  EXPECT_THAT(with("-3 0 -1 2", ""), HasSubstr("lie outside of 0 to 3, when it acts: its factor is 2"));
  EXPECT_THAT(faults(Parts{.constraint = R"(<forceConstraint indices="${i}" force="1 0 0" table="0 1 2 0 1 3"/>)"}),
              HasSubstr("s.xml:6: table: times must ascend, but 1 follows 2"));
}

}  // namespace
}  // namespace msml
