// SPDX-License-Identifier: GPL-3.0-or-later
// References, variables, names and types of edges.
#include <gtest/gtest.h>

#include "msml/compile/scope.hpp"
#include "tests/compile/objects.hpp"

namespace msml {
namespace {

using tiny::compiled;
using tiny::faults_of;
using tiny::object;
using tiny::task_faults;
using tiny::with_variables;

constexpr const char* surface = "<MakeSurface id=\"skin\"/>";

TEST(References, UnknownNameShowsTheNearest) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"liver\"/>\n<Fill surfaceMesh=\"${livre}\" cellSize=\"1\"/>"),
            "s.xml:3: ${livre} names no variable, task or output (did you mean 'liver'?)");
  EXPECT_EQ(task_faults("<Fill surfaceMesh=\"${liver}\" cellSize=\"1\"/>"),
            "s.xml:2: ${liver} names no variable, task or output");
}

TEST(References, UnknownOutputShowsThoseThereAre) {
  EXPECT_EQ(task_faults(std::string(surface) + "\n<Fill id=\"f\" surfaceMesh=\"${skin}\" cellSize=\"1\"/>\n"
                                               "<Skin mesh=\"${f.mseh}\"/>"),
            "s.xml:4: ${f.mseh}: Fill at line 3 has no output mseh (did you mean 'mesh'?); it has mesh, cells");
}

TEST(References, OutputOfAVariableIsAFault) {
  EXPECT_EQ(faults_of(with_variables("<var name=\"v\" value=\"a\"/>\n", "<Skin mesh=\"${v.mesh}\"/>")),
            "s.xml:4: ${v.mesh}: v is the variable at line 2, which has no outputs");
}

TEST(References, PartOfASceneOutputIsAFault) {
  EXPECT_EQ(faults_of(object({.tasks = "<Skin mesh=\"${disp.last}\"/>"})),
            "s.xml:17: ${disp.last}: the output disp has no parts");
}

TEST(References, NamedOutputsConnect) {
  const Compilation result = compiled(tiny::workflow(
      std::string(surface) + "<Fill id=\"f\" surfaceMesh=\" ${ skin } \" cellSize=\"1\"/><Skin mesh=\"${f.mesh}\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(std::get<Edge>(result.graph.nodes.at(1).args.sources.at(0)).node, 0);
  EXPECT_EQ(std::get<Edge>(result.graph.nodes.at(2).args.sources.at(0)).node, 1);
}

TEST(References, UnclosedReferenceIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface label=\"${skin\"/>"), "s.xml:2: label = ${skin: '${' is not closed by '}'");
}

TEST(References, EmptyReferenceIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface label=\"a ${ } b\"/>"), "s.xml:2: label = a ${ } b: '${}' names nothing");
}

TEST(References, TaskJoinedWithTextIsAFault) {
  EXPECT_EQ(task_faults(std::string(surface) + "\n<MakeSurface label=\"${skin}_fine\"/>"),
            "s.xml:3: label: ${skin} is the result of a task and cannot be joined with text");
  EXPECT_EQ(task_faults("<MakeSurface id=\"a\" file=\"x${a}.tri\"/>"),
            "s.xml:2: file: ${a} is the result of a task and cannot be joined with text");
}

TEST(References, UnknownNameJoinedWithTextIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface label=\"${nobody}_fine\"/>"),
            "s.xml:2: ${nobody} names no variable, task or output");
}

TEST(References, TextIsJoinedWithVariables) {
  const Compilation result = compiled(with_variables(
      "<var name=\"organ\" value=\"liver\"/><var name=\"stem\" value=\"${organ}_${n}\"/><var name=\"n\" value=\"2\"/>",
      "<MakeSurface label=\"my ${stem}!\" file=\"${stem}.tri\" count=\"${n}${n}\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  const Node& node = result.graph.nodes.at(0);
  EXPECT_EQ(node.targets.at(0).file, "liver_2.tri");
  EXPECT_EQ(std::get<std::string>(std::get<Value>(node.args.sources.at(6))), "my liver_2!");
  EXPECT_EQ(std::get<Integer>(std::get<Value>(node.args.sources.at(3))), 22);
}

TEST(References, VariablesInACircleAreAFault) {
  EXPECT_EQ(faults_of(with_variables("<var name=\"a\" value=\"${b}\"/><var name=\"b\" value=\"${a}\"/>\n",
                                     "<MakeSurface radius=\"${a}\"/>")),
            "s.xml:4: radius = ${a}: the variables refer to each other in a circle");
  EXPECT_EQ(faults_of(with_variables("<var name=\"a\" value=\"x${a}\"/>\n", "<MakeSurface label=\"${a}\"/>")),
            "s.xml:4: label: the variable a (line 2) does not stand for text: it leads to a task, to no name, back to "
            "itself, or grows without bound");
}

TEST(References, VariableBombIsRefusedWithoutExpanding) {
  std::string variables = "<var name=\"v0\" value=\"ha\"/>";
  for (int i = 1; i <= 30; ++i)
    variables += "<var name=\"v" + std::to_string(i) + "\" value=\"${v" + std::to_string(i - 1) + "}${v" +
                 std::to_string(i - 1) + "}\"/>";
  EXPECT_EQ(
      faults_of(with_variables(variables + "\n", "<MakeSurface label=\"${v30}\"/>")),
      "s.xml:4: label: the variable v29 (line 2) does not stand for text: it leads to a task, to no name, back to "
      "itself, or grows without bound");
}

TEST(References, VariableBombOfEmptyTextsIsRefused) {
  std::string variables = "<var name=\"v0\" value=\"\"/>";
  for (int i = 1; i <= 30; ++i)
    variables += "<var name=\"v" + std::to_string(i) + "\" value=\"${v" + std::to_string(i - 1) + "}${v" +
                 std::to_string(i - 1) + "}\"/>";
  EXPECT_NE(faults_of(with_variables(variables, "<MakeSurface label=\"${v30}\"/>")), "");
}

TEST(References, WrongTypeNamesBothEndsAndWhatLiesBetween) {
  EXPECT_EQ(task_faults(std::string(surface) + "\n<Fill id=\"f\" surfaceMesh=\"${skin}\" cellSize=\"1\"/>\n"
                                               "<Voxelize id=\"v\"\n surface=\"${f}\"/>"),
            "s.xml:5: surface of Voxelize 'v' needs a Surface, but ${f} is the Mesh 'mesh' of Fill at line 3; between "
            "them: Skin");
  EXPECT_EQ(
      task_faults(std::string(surface) + "\n<Sum image=\"${skin}\"/>"),
      "s.xml:3: image of Sum needs a list of images, but ${skin} is the Surface 'surface' of MakeSurface at line 2");
  EXPECT_EQ(task_faults(std::string(surface) + "\n<Paint where=\"${skin}\"/>"),
            "s.xml:3: where of Paint needs an IndexSet, but ${skin} is the Surface 'surface' of MakeSurface at line 2");
}

TEST(References, NumberWhereIntegerIsNeededIsAFault) {
  EXPECT_EQ(task_faults("<Paint id=\"p\" where=\"1\"/>\n<MakeSurface count=\"${p.mean}\" radius=\"${p.mean}\"/>"),
            "s.xml:3: count of MakeSurface needs an integer, but ${p.mean} is the number 'mean' of Paint at line 2");
}

TEST(References, LossFreeConversionsAreImplicit) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"s\"/><Skin mesh=\"${s}\"/><Voxelize id=\"v\" surface=\"${s}\"/>"
                        "<Sum id=\"t\" image=\"${v}\"/><MakeSurface radius=\"${t.count}\" label=\"${t.count}\" "
                        "centers=\"${t.count}\" ids=\"${t.count}\"/>"),
            "");
}

TEST(References, FileOfATaskThatWritesNoneIsAFault) {
  EXPECT_EQ(task_faults(std::string(surface) + "\n<Copy from=\"${skin}\"/>"),
            "s.xml:3: from of Copy needs a file, but ${skin} of MakeSurface at line 2 is not written to one: name a "
            "target there");
}

TEST(References, TargetIsTheNameOfAFile) {
  EXPECT_EQ(
      task_faults(std::string(surface) + "\n<MakeSurface id=\"b\" file=\"${skin}\"/>"),
      "s.xml:3: file of MakeSurface 'b' is the name of a file to write, but ${skin} is the Surface of MakeSurface "
      "at line 2");
}

TEST(References, NamesOfOtherAlphabetsWork) {
  EXPECT_EQ(faults_of(with_variables("<var name=\"Größe\" value=\"2\"/>",
                                     "<MakeSurface id=\"肝臓\" radius=\"${Größe}\"/>"
                                     "<Fill id=\"печень\" surfaceMesh=\"${肝臓}\" cellSize=\"${Größe}\"/>")),
            "");
  EXPECT_EQ(task_faults("<MakeSurface id=\"肝臓\"/>\n<Fill surfaceMesh=\"${肝蔵}\" cellSize=\"1\"/>"),
            "s.xml:3: ${肝蔵} names no variable, task or output (did you mean '肝臓'?)");
}

TEST(References, NamesOfOneScopeDiffer) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"a\"/>\n<MakeSurface id=\"a\"/>"),
            "s.xml:3: the name a is taken: it is declared at line 2; variables, tasks and outputs share one scope");
  EXPECT_EQ(faults_of(with_variables("<var name=\"a\" value=\"1\"/>\n<var name=\"a\" value=\"2\"/>\n",
                                     "<MakeSurface id=\"a\"/>")),
            "s.xml:3: the name a is taken: it is declared at line 2; variables, tasks and outputs share one scope\n"
            "s.xml:5: the name a is taken: it is declared at line 2; variables, tasks and outputs share one scope");
  EXPECT_EQ(faults_of(object({.output = "<states id=\"m\"/>"})),
            "s.xml:11: the name m is taken: it is declared at line 17; variables, tasks and outputs share one scope");
}

TEST(References, LabelsOfOtherKindsMayRepeatNames) {
  EXPECT_EQ(faults_of(object({.mesh = "<linearTet id=\"body\" mesh=\"${m}\"/>",
                              .region = "id=\"body\" indices=\"${r}\"",
                              .constraint = "<hold name=\"body\" indices=\"0\"/>"})),
            "");
}

TEST(References, NamesHoldNoBlanksDotsOrBraces) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"a b\"/>"),
            "s.xml:2: id = 'a b' is not a name: no blanks, dots, braces or $");
  EXPECT_EQ(task_faults("<MakeSurface id=\"\"/>"), "s.xml:2: id = '' is not a name: no blanks, dots, braces or $");
  EXPECT_EQ(faults_of(with_variables("<var name=\"a.b\" value=\"1\"/>\n", "")),
            "s.xml:2: name = 'a.b' is not a name: no blanks, dots, braces or $");
  EXPECT_EQ(faults_of(object({.output = "<states id=\"a/b\"/>"})),
            "s.xml:11: id = 'a/b' names files: no blanks, dots, slashes, quotes, braces or *");
  EXPECT_EQ(faults_of(object({.output = "<states id=\"\"/>"})),
            "s.xml:11: the id of states is empty, but names its files");
}

TEST(References, SettingGivesAVariableAnotherValue) {
  const std::string text = with_variables("<var name=\"r\" value=\"1\"/>\n", "<MakeSurface radius=\"${r}\"/>");
  const Compilation result = compiled(text, {.set = {{"r", "7"}}});
  EXPECT_EQ(std::get<double>(std::get<Value>(result.graph.nodes.at(0).args.sources.at(0))), 7.0);
  EXPECT_EQ(faults_of(text, {.set = {{"r", "-7"}}}), "s.xml:4: radius = -7 is not > 0 (from the variable at line 2)");
}

TEST(References, SettingOfAnUnknownVariableIsAFault) {
  EXPECT_EQ(faults_of(with_variables("<var name=\"radius\" value=\"1\"/>\n", ""), {.set = {{"raduis", "7"}}}),
            "s.xml: --set raduis=7: the scene has no variable raduis (did you mean 'radius'?)");
  EXPECT_EQ(faults_of("<msml/>", {.set = {{"r", "7"}}}), "s.xml: --set r=7: the scene has no variable r");
  EXPECT_EQ(task_faults(surface, {.set = {{"skin", "7"}}}), "s.xml: --set skin=7: the scene has no variable skin");
}

TEST(References, UnusedVariableIsNoted) {
  EXPECT_EQ(tiny::lines(compiled(with_variables("<var name=\"r\" value=\"1\"/>\n", "")).notes),
            "s.xml:2: the variable r is not used");
}

TEST(Patterns, StarStandsForAnyText) {
  std::string star;
  EXPECT_TRUE(matches("a*.vtk", "a12.vtk", &star));
  EXPECT_EQ(star, "12");
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("a*b*c", "axxbyybzc", &star));
  EXPECT_EQ(star, "xx");
  EXPECT_TRUE(matches("**a", "bca"));
  EXPECT_FALSE(matches("ab*ba", "aba"));
  EXPECT_FALSE(matches("a*b*c", "acb"));
  EXPECT_FALSE(matches("a.vtk", "b.vtk"));
  EXPECT_FALSE(matches("a*bc*c", "abc"));
}

TEST(Patterns, ManyStarsTakeNoLonger) {
  std::string pattern;
  for (int i = 0; i < 2000; ++i) pattern += "a*";
  EXPECT_FALSE(matches(pattern + "b", std::string(100'000, 'a')));
  EXPECT_TRUE(matches(pattern, std::string(100'000, 'a')));
}

TEST(Patterns, NumbersSortByValue) {
  EXPECT_TRUE(natural_less("a2.vtk", "a10.vtk"));
  EXPECT_FALSE(natural_less("a10.vtk", "a2.vtk"));
  EXPECT_TRUE(natural_less("a002", "a10"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("x99999999999999999999998", "x99999999999999999999999"));
  EXPECT_FALSE(natural_less("a", "a"));
}

}  // namespace
}  // namespace msml
