// SPDX-License-Identifier: GPL-3.0-or-later
// What is static and pushed needs a hold, and what a scene says twice or in vain is noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/scene_parts.hpp"

namespace msml {
namespace {

using testing::HasSubstr;

constexpr const char* hold = R"(<fixedConstraint indices="${i}"/>)";
constexpr const char* heat = R"(<diffusionMaterial coefficient="1"/>)";

TEST(HeldLanguage, GravityNeedsAHoldInStatics) {
  const auto with = [](const std::string& constraint, const std::string& solver = "static") {
    return faults(Parts{.solver = "<solver timeIntegration=\"" + solver + "\"/>",
                        .constraint = constraint,
                        .step = R"(<step name="one" gravity="0 0 -9"/>)"});
  };
  const auto missing = HasSubstr("s.xml:12: step: gravity pulls, but nothing holds the body, which is static");
  EXPECT_THAT(with(""), missing);
  EXPECT_THAT(with("", "quasiStatic"), missing);
  EXPECT_THAT(faults(Parts{.step = "<step/>"}), missing);  // that of the earth
  EXPECT_THAT(with(R"(<initialDisplacement displacement="0 0 0"/>)"), missing);
  EXPECT_EQ(with("", "Newmark"), "");
  EXPECT_EQ(with(hold), "");
  EXPECT_EQ(with(R"(<springToPoint indices="${i}" point="0 0 9" stiffness="1"/>)"), "");
  EXPECT_EQ(with(R"(<forceConstraint indices="${i}" force="0 0 1"/>)"), "");  // the run sees whether they balance
  EXPECT_EQ(with(R"(<hold/>)").find("gravity"), std::string::npos);           // an unknown tag may hold it
  EXPECT_EQ(faults(Parts{.step = R"(<step gravity="0 0 Z-0.5"/>)"}), "");
  EXPECT_EQ(faults(Parts{.mesh = R"(<linearTriangle mesh="${b}"/>)", .step = "<step/>"}), "");  // across its plane
}

TEST(HeldLanguage, EachStepNeedsItsOwn) {
  const auto with = [](const std::string& constraint) {
    return faults(Parts{.constraint = constraint,
                        .step = R"(<step name="one" gravity="0 0 0"/><step name="two" gravity="0 0 -9"/>)"});
  };
  EXPECT_THAT(with(R"(<fixedConstraint indices="${i}" forStep="one"/>)"), HasSubstr("nothing holds the body"));
  EXPECT_EQ(with(R"(<displacementConstraint indices="${i}" displacement="0 0 0" forStep="one"/>)"), "");  // it lasts
  EXPECT_EQ(with(R"(<fixedConstraint indices="${i}" forStep="two"/>)"), "");
}

TEST(HeldLanguage, ASourceNeedsADrain) {
  const auto with = [](const std::string& constraint) {
    return faults(Parts{.region = heat, .constraint = constraint});
  };
  EXPECT_THAT(with(R"(<source value="2"/>)"), HasSubstr("s.xml:12: step: the source feeds a stationary problem"));
  EXPECT_EQ(with(R"(<source value="2"/><fixedValue indices="${i}" value="0"/>)"), "");
  EXPECT_EQ(with(R"(<source value="2"/><flux indices="${i}" value="-1"/>)"), "");
  EXPECT_EQ(with(R"(<source value="X - 0.5"/>)"), "");
}

TEST(IdleLanguage, WhatIsSaidInVainIsNoticed) {
  EXPECT_THAT(warnings(Parts{.region = std::string(heat) + R"(<mass massDensity="2"/>)"}),
              HasSubstr("s.xml:4: mass: it means nothing beside diffusionMaterial"));
  EXPECT_THAT(warnings(Parts{.output = R"(<displacement id="d" timestep="3" every="2"/>)"}),
              HasSubstr("s.xml:8: displacement: timestep means nothing here: it needs every to be absent"));
  EXPECT_EQ(warnings(Parts{.output = R"(<displacement id="d" timestep="3"/>)"}), "");
  const std::string once =
      R"(<solver timeIntegration="static" newtonIterations="1" tolerance="1e-3" lineSearch="false"/>)";
  EXPECT_THAT(warnings(Parts{.solver = once}), testing::AllOf(HasSubstr("solver: tolerance means nothing here"),
                                                              HasSubstr("solver: lineSearch means nothing here")));
}

}  // namespace
}  // namespace msml
