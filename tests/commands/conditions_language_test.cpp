// SPDX-License-Identifier: GPL-3.0-or-later
// Conditions and outputs of the real language: text in, message out.
#include <gtest/gtest.h>

#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

/// Faults of a sound scene with one more condition on line 2 and one more output on line 3. Long lists of what is
/// allowed are cut off.
std::string faults(const std::string& constraint, const std::string& output = "") {
  const std::string scene =
      "<msml><scene><object><constraints><constraint>\n" + constraint + "</constraint></constraints><output>\n" +
      output +
      "</output>\n<mesh><linearTet mesh=\"${b}\"/></mesh><material><region indices=\"${i}\">"
      "<linearElasticMaterial youngModulus=\"1\" poissonRatio=\"0.3\"/></region></material></object></scene><workflow>"
      "<GenerateBoxMesh id=\"b\" size=\"1 1 1\" divisions=\"1 1 1\"/>"
      "<ComputeIndicesFromBoxROI id=\"i\" mesh=\"${b}\" select=\"points\" box=\"0 0 0 1 1 1\"/>"
      "</workflow></msml>";
  std::string text =
      tiny::lines(compile_text(scene, "/nonexistent/s.xml", real_language(), {.output_folder = "/nonexistent"}).faults);
  if (const auto at = text.find("; an expression may use"); at != std::string::npos) text = text.substr(0, at);
  if (const auto at = text.find(" is not one of "); at != std::string::npos)
    text = text.substr(0, at) + text.substr(std::min(text.size(), text.find(" (did you mean")));
  return text;
}

TEST(ConditionsLanguage, LoadsAndSupportsTakeExpressions) {
  EXPECT_EQ(faults("<displacementConstraint indices=\"${i}\" displacement=\"sin(pi*t), 0, X*Y\"/>"), "");
  EXPECT_EQ(faults("<forceConstraint indices=\"${i}\" force=\"0 0 -t\"/>"), "");
  EXPECT_EQ(faults("<surfacePressure indices=\"${i}\" pressure=\"1 - exp(-t)\"/>"), "");
  EXPECT_EQ(faults("<surfaceTraction indices=\"${i}\" traction=\"X, Y, Z\"/>"), "");
  EXPECT_EQ(faults("<bodyForce force=\"0, 0, -9.81*(1 + X)\"/>"), "");
  EXPECT_EQ(faults("<initialVelocity velocity=\"-Y, X, 0\"/>"), "");
}

TEST(ConditionsLanguage, BlanksDivideListsWhereEachPartIsAnExpression) {
  EXPECT_EQ(faults("<surfacePressure indices=\"${i}\" pressure=\"1 - exp(-t)\"/>"), "");
  EXPECT_EQ(faults("<displacementConstraint indices=\"${i}\" displacement=\"Y -Z -X\"/>"), "");
  EXPECT_NE(faults("<displacementConstraint indices=\"${i}\" displacement=\"Y -Z\"/>"), "");
}

TEST(ConditionsLanguage, FaultsOfExpressionsNameTheirPlace) {
  EXPECT_EQ(faults("<displacementConstraint indices=\"${i}\" displacement=\"sin(T), 0, 0\"/>"),
            "s.xml:2: displacement: entry 1 of the list = sin(T): 'T' at position 5 is unknown");
  EXPECT_EQ(faults("<forceConstraint indices=\"${i}\" force=\"1/0 0 0\"/>"),
            "s.xml:2: force: entry 1 of the list = 1/0 is not a finite number");
  EXPECT_EQ(faults("<initialVelocity velocity=\"t 0 0\"/>"),
            "s.xml:2: velocity: 't' depends on t, but the start has one time; use X, Y and Z");
}

TEST(ConditionsLanguage, TablesAreCheckedBeforeAnythingRuns) {
  EXPECT_EQ(faults("<forceConstraint indices=\"${i}\" force=\"0 0 1\" table=\"0 0 1 1\"/>"), "");
  EXPECT_EQ(faults("<forceConstraint indices=\"${i}\" force=\"0 0 1\" table=\"0 0 1\"/>"),
            "s.xml:2: table has 3 values, but needs a multiple of 2");
  EXPECT_EQ(faults("<forceConstraint indices=\"${i}\" force=\"0 0 1\" table=\"0 0 2 1 2 3\"/>"),
            "s.xml:2: table: times must ascend, but 2 follows 2; it lists time, factor, time, factor, …");
}

TEST(ConditionsLanguage, ComponentsAndFieldsAreCheckedBeforeAnythingRuns) {
  EXPECT_EQ(faults("<fixedConstraint indices=\"${i}\" components=\"z, x\"/>"), "");
  EXPECT_EQ(faults("<fixedConstraint indices=\"${i}\" components=\"x w\"/>"), "s.xml:2: components = w");
  EXPECT_EQ(faults("<fixedConstraint indices=\"${i}\" components=\" \"/>"),
            "s.xml:2: components: it names no axis; allowed are x, y and z");
  EXPECT_EQ(faults("", "<result id=\"r\" fields=\"J vonmises\"/>"),
            "s.xml:3: fields = vonmises (did you mean 'vonMises'?)");
}

TEST(ConditionsLanguage, ANormalNeedsADirection) {
  EXPECT_EQ(faults("<symmetryPlane indices=\"${i}\" normal=\"1 1 0\"/>"), "");
  EXPECT_EQ(faults("<symmetryPlane indices=\"${i}\" normal=\"0 0 0\"/>"), "s.xml:2: normal: 0 0 0 has no direction");
}

}  // namespace
}  // namespace msml
