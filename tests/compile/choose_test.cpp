// SPDX-License-Identifier: GPL-3.0-or-later
// Tags under a condition.
#include <gtest/gtest.h>

#include "tests/compile/scenes.hpp"

namespace msml::tiny {
namespace {

/// A surface that is filled or not, by the variable `kind`.
std::string scene(const std::string& kind, const std::string& condition) {
  return with_variables("<var name=\"kind\" value=\"" + kind + "\"/>\n",
                        "<MakeSurface id=\"s\" file=\"a.tri\" when=\"" + condition + "\"/>");
}

std::size_t nodes(const std::string& text, const CompileOptions& options = {}) {
  const Compilation result = compiled(text, options);
  EXPECT_EQ(lines(result.faults), "");
  return result.graph.nodes.size();
}

TEST(When, ATagStaysWhereItsConditionHolds) {
  EXPECT_EQ(nodes(scene("a", "${kind} = a")), 1U);
  EXPECT_EQ(nodes(scene("b", "${kind} = a")), 0U);
  EXPECT_EQ(nodes(scene("b", "${kind} != a")), 1U);
  EXPECT_EQ(nodes(scene("b", "${kind} = a | b")), 1U);
  EXPECT_EQ(nodes(scene("b", "${kind} != a | b")), 0U);
  EXPECT_EQ(nodes(scene("0.30", "${kind} = .3")), 1U) << "numbers compare as numbers";
}

TEST(When, TheCommandLineDecides) {
  CompileOptions options;
  options.set["kind"] = "b";
  EXPECT_EQ(nodes(scene("a", "${kind} = b"), options), 1U);
}

TEST(When, TwoTagsMayShareANameIfOneOfThemStays) {
  EXPECT_EQ(nodes(with_variables("<var name=\"kind\" value=\"a\"/>\n",
                                 "<MakeSurface id=\"s\" when=\"${kind} = a\"/><MakeSurface id=\"s\" when=\"${kind} = "
                                 "b\"/>")),
            1U);
}

TEST(When, AConditionThatSaysNothingIsRefused) {
  EXPECT_EQ(faults_of(scene("a", "${kind}")),
            "s.xml:4: when = ${kind}: a condition is ${variable} = value, or !=, with '|' between alternatives");
  EXPECT_EQ(faults_of(scene("a", "${kin} = a")),
            "s.xml:4: when = ${kin} = a: ${kin} is no variable (did you mean "
            "'kind'?)");
  EXPECT_EQ(faults_of(scene("${kind}", "${kind} = a")),
            "s.xml:4: when = ${kind} = a: the variables refer to each other in a circle");
}

}  // namespace
}  // namespace msml::tiny
