// SPDX-License-Identifier: GPL-3.0-or-later
// Text of <studies> in, plain structs or messages with their lines out.
#include <gtest/gtest.h>

#include "tests/compile/scenes.hpp"

namespace msml::tiny {
namespace {

/// A scene with the variables h and kind and a report; the inside of a study starts on line 4.
std::string with_study(const std::string& inside, const std::string& attributes = "id=\"s\"") {
  return "<msml><variables><var name=\"h\" value=\"1\"/><var name=\"kind\" value=\"exact\"/></variables>\n"
         "<workflow><MakeSurface id=\"a\" radius=\"${h}\" method=\"${kind}\"/><Fill id=\"b\" surfaceMesh=\"${a}\" "
         "cellSize=\"1\"/><Measure id=\"m\" mesh=\"${b}\"/></workflow>\n"
         "<studies><study " +
         attributes + ">\n" + inside + "</study></studies></msml>";
}

std::string study_faults(const std::string& inside, const std::string& attributes = "id=\"s\"") {
  return faults_of(with_study(inside, attributes));
}

TEST(StudyLanguage, AStudyIsReadWithItsDefaults) {
  const Compilation result =
      compiled(with_study("<vary variable=\"h\" from=\"1\" to=\"8\" count=\"4\" scale=\"log\"/>\n"
                          "<measure value=\"m\"/>\n<measure time=\"total\"/>\n"
                          "<chart x=\"h\" y=\"m\"/>"));
  ASSERT_EQ(lines(result.faults), "");
  const Study& study = result.studies.at(0);
  EXPECT_EQ(study.variables(), std::vector<std::string>{"h"});
  ASSERT_EQ(study.vary[0].values.size(), 4U);
  EXPECT_EQ(study.vary[0].values[2][0], "4");
  EXPECT_EQ(study.measures[0].id, "m");
  EXPECT_EQ(study.measures[1].id, "time_total");
  EXPECT_EQ(study.repetitions(), 5) << "where time is measured";
  EXPECT_EQ(study.charts[0].id, "m_over_h");
}

TEST(StudyLanguage, NamesThatDoNotExistAreFoundAtTheirLine) {
  EXPECT_EQ(study_faults("<vary variable=\"hh\" values=\"1 2\"/>"),
            "s.xml:4: the scene has no variable hh (did you mean 'h'?)");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<measure value=\"n\"/>"),
            "s.xml:5: measure 'n': the scene has no task or output n");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<measure time=\"tota\"/>"),
            "s.xml:5: time = tota is none of run, apart, total, own, simulation, step, setup, assembly, linear, and no "
            "task has this id "
            "(did you mean 'total'?)");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/><measure value=\"m\"/>\n<chart x=\"h\" y=\"mm\"/>"),
            "s.xml:5: y = mm is no column of the study (did you mean 'm'?); it has h, m, unknowns");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/><measure value=\"m\"/>\n"
                         "<chart x=\"h\" y=\"m\" group=\"kind\"/>"),
            "s.xml:5: group = kind is no variable of the study; it has h");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<reference set=\"k=1\"/>"),
            "s.xml:5: the scene has no variable k");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<reference file=\"nothere.vtu\"/>"),
            "s.xml:5: file = nothere.vtu does not exist");
}

TEST(StudyLanguage, WhatMakesNoSenseIsRefusedBeforeAnythingRuns) {
  EXPECT_EQ(study_faults("<vary variable=\"h\"/>"), "s.xml:4: vary needs values, or from and to with count");
  EXPECT_EQ(study_faults("<vary variable=\"h\" from=\"1\" to=\"2\"/>"),
            "s.xml:4: h varies over a range, which needs count");
  EXPECT_EQ(study_faults("<vary variable=\"h\" from=\"0\" to=\"2\" count=\"3\" scale=\"log\"/>"),
            "s.xml:4: scale = log needs from and to > 0, not 0 and 2");
  EXPECT_EQ(study_faults("<vary variable=\"h kind\" values=\"1 exact; 2\"/>"),
            "s.xml:4: values: '2' has 1 words, but 2 variables vary together (h kind)");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/><vary variable=\"h\" values=\"2\"/>"),
            "s.xml:4: h varies twice, or is the name of another column");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<measure error=\"L2\"/>"),
            "s.xml:5: an error needs a <reference> in the study");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<measure/>"),
            "s.xml:5: measure needs one of error, time, memory, iterations, probe, value, energy");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>\n<reference set=\"h=1\" file=\"a.tet\"/>"),
            "s.xml:5: reference needs one of set, file, expression, extrapolate");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1 2\"/>\n<reference extrapolate=\"h\"/>"),
            "s.xml:5: extrapolate = h: no <vary> gives this variable three values or more");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>", "id=\"a b\""),
            "s.xml:3: id = 'a b' names a folder: no blanks, dots, slashes, quotes, braces or *");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1 2\"/><vary variable=\"kind\" values=\"fast\"/>",
                         "id=\"s\" combine=\"zip\""),
            "s.xml:4: combine = zip: kind has 1 values, but h has 2");
}

// A wrong attribute, a value that makes no sense, a name that does not exist and a chart of nothing, all in one go;
// what only follows from another fault is not told.
TEST(StudyLanguage, AllFaultsComeInOneRound) {
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1 2\"/>\n<vary variable=\"hh\" values=\"1\"/>\n"
                         "<measure value=\"m\" relativ=\"true\"/>\n<measure/>\n<measure id=\"w\" value=\"wrong\"/>\n"
                         "<chart x=\"h\" y=\"m\"/>\n<chart x=\"h\" y=\"w\" group=\"kind\"/>",
                         "id=\"a b\" limit=\"-1\""),
            "s.xml:3: limit = -1 is not > 0\n"
            "s.xml:3: id = 'a b' names a folder: no blanks, dots, slashes, quotes, braces or *\n"
            "s.xml:5: the scene has no variable hh (did you mean 'h'?)\n"
            "s.xml:6: measure has no attribute relativ (did you mean 'relative'?)\n"
            "s.xml:7: measure needs one of error, time, memory, iterations, probe, value, energy\n"
            "s.xml:8: measure 'w': the scene has no task or output wrong\n"
            "s.xml:10: group = kind is no variable of the study; it has h, hh");
}

TEST(StudyLanguage, ALimitIsLookedForAlongOneVariableAmongOthers) {
  const std::string measure = "<measure value=\"m\" error=\"RMS\"/>";
  EXPECT_EQ(
      study_faults("<vary variable=\"h kind\" values=\"1 a; 2 a; 4 a\"/>\n<reference extrapolate=\"h\"/>" + measure),
      "");
  EXPECT_EQ(
      study_faults("<vary variable=\"h kind\" values=\"1 a; 2 a; 2 b\"/>\n<reference extrapolate=\"h\"/>" + measure),
      "s.xml:5: extrapolate = h: no <vary> gives this variable three values or more");
  EXPECT_EQ(study_faults("<vary variable=\"h\" from=\"1\" to=\"2\"/>\n<reference extrapolate=\"h\"/>" + measure,
                         "id=\"s\" combine=\"latinHypercube\""),
            "s.xml:5: extrapolate needs values from coarse to fine, but combine = latinHypercube draws them");
}

TEST(StudyLanguage, TagsAndAttributesAreCheckedAsAllOthers) {
  EXPECT_EQ(study_faults("<vary variabel=\"h\" values=\"1\"/>"),
            "s.xml:4: vary has no attribute variabel (did you mean 'variable'?)\n"
            "s.xml:4: vary needs the attribute variable: its name; several names vary together");
  EXPECT_EQ(study_faults("<measure time=\"total\"/>"), "s.xml:3: study needs <vary> inside");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/><plot/>"),
            "s.xml:4: unknown tag plot inside study; known there: vary, reference, measure, chart");
  EXPECT_EQ(study_faults("<vary variable=\"h\" values=\"1\"/>", "id=\"s\" limit=\"-1\""),
            "s.xml:3: limit = -1 is not > 0");
}

}  // namespace
}  // namespace msml::tiny
