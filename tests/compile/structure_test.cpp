// SPDX-License-Identifier: GPL-3.0-or-later
// Tags and attributes: unknown, misplaced, missing, too many, not available yet, left over from old scenes.
#include <gtest/gtest.h>

#include "tests/compile/objects.hpp"

namespace msml {
namespace {

using tiny::faults_of;
using tiny::object;
using tiny::task_faults;

TEST(Structure, UnknownTagShowsTheNearestName) {
  EXPECT_EQ(task_faults("<MakeSurfaec/>"),
            "s.xml:2: unknown tag MakeSurfaec inside workflow (did you mean 'MakeSurface'?)");
  EXPECT_EQ(faults_of("<msml>\n<worflow/></msml>"),
            "s.xml:2: unknown tag worflow inside msml (did you mean 'workflow'?)");
}

TEST(Structure, UnknownTagWithoutNeighbourShowsWhatIsKnown) {
  EXPECT_EQ(faults_of("<msml>\n<banana/></msml>"),
            "s.xml:2: unknown tag banana inside msml; known there: variables, scene, workflow, environment, studies");
}

TEST(Structure, MisplacedTagShowsItsPlace) {
  EXPECT_EQ(faults_of("<msml>\n<region/></msml>"),
            "s.xml:2: region may not stand inside msml; its place is inside material");
  EXPECT_EQ(faults_of("<msml>\n<MakeSurface/></msml>"),
            "s.xml:2: MakeSurface may not stand inside msml; its place is inside workflow");
  EXPECT_EQ(task_faults("<var name=\"a\" value=\"1\"/>"),
            "s.xml:2: var may not stand inside workflow; its place is inside variables");
}

TEST(Structure, SimulateIsNoTaskOfAWorkflow) {
  EXPECT_EQ(task_faults("<Simulate/>"),
            "s.xml:2: unknown tag Simulate inside workflow; known there: MakeSurface, Fill, Skin, Pick, Paint, "
            "Voxelize, Sum, "
            "Copy, Measure, Later");
}

TEST(Structure, TagWithoutChildrenTakesNone) {
  EXPECT_EQ(faults_of("<msml><variables>\n<var name=\"a\" value=\"1\">\n<b/></var></variables></msml>"),
            "s.xml:3: var takes no tags inside, but holds b");
}

TEST(Structure, TagThatMayStandOnceStandsOnce) {
  EXPECT_EQ(faults_of("<msml>\n<workflow/>\n<workflow/>\n</msml>"),
            "s.xml:3: msml holds 2 tags of the kind <workflow>, but one at most");
}

TEST(Structure, ObjectNeedsMeshAndMaterial) {
  EXPECT_EQ(faults_of("<msml><scene>\n<object id=\"o\"/></scene></msml>"),
            "s.xml:2: object needs <mesh> inside\ns.xml:2: object needs <material> inside");
}

TEST(Structure, MeshNeedsOneKind) {
  EXPECT_EQ(faults_of(object({.mesh = ""})), "s.xml:3: mesh needs one of <linearTet> or <quadraticTet> inside");
  EXPECT_EQ(faults_of(object({.mesh = "<linearTet mesh=\"${m}\"/>\n<quadraticTet mesh=\"${m}\"/>"})),
            "s.xml:4: mesh holds 2 tags of the kind <linearTet> or <quadraticTet>, but one at most");
}

TEST(Structure, RegionNeedsALaw) {
  EXPECT_EQ(faults_of(object({.law = ""})), "s.xml:5: region needs <softMaterial> inside");
}

TEST(Structure, MaterialNeedsARegion) {
  EXPECT_EQ(
      faults_of(
          "<msml><scene><object>\n<mesh><linearTet mesh=\"1.tet\"/></mesh>\n<material/>\n</object></scene></msml>"),
      "s.xml:2: mesh = 1.tet names no file beside the scene and no task's target\n"
      "s.xml:3: material needs <region> inside");
}

TEST(Structure, SimulationNeedsAStep) {
  EXPECT_EQ(faults_of("<msml><environment>\n<simulation/></environment></msml>"),
            "s.xml:2: simulation needs <step> inside");
}

TEST(Structure, MissingAttributeIsNamedWithItsMeaning) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"m\"/>\n<Fill surfaceMesh=\"${m}\"/>"),
            "s.xml:3: Fill needs the attribute cellSize: size of the cells");
  EXPECT_EQ(task_faults("<Fill cellSize=\"1\"/>"), "s.xml:2: Fill needs the attribute surfaceMesh: what is filled");
  EXPECT_EQ(faults_of("<msml><variables>\n<var name=\"a\"/></variables></msml>"),
            "s.xml:2: var needs the attribute value: a literal of the type of the attribute it is used in");
}

TEST(Structure, UnknownAttributeShowsTheNearestName) {
  EXPECT_EQ(task_faults("<MakeSurface\n raduis=\"3\"/>"),
            "s.xml:3: MakeSurface has no attribute raduis (did you mean 'radius'?)");
  EXPECT_EQ(faults_of(object({.law = "<softMaterial youngModulus=\"1\" poisonRatio=\"0.2\"/>"})),
            "s.xml:5: softMaterial has no attribute poisonRatio (did you mean 'poissonRatio'?)");
}

TEST(Structure, UnknownAttributeWithoutNeighbourShowsAll) {
  EXPECT_EQ(task_faults("<Skin mesh=\"${f}\" colour=\"red\"/>\n<Fill id=\"f\" surfaceMesh=\"${s}\" cellSize=\"1\"/>"
                        "<MakeSurface id=\"s\"/>"),
            "s.xml:2: Skin has no attribute colour; it has mesh, file");
}

TEST(Structure, HoldersRefuseAttributesToo) {
  EXPECT_EQ(faults_of("<msml colour=\"red\">\n<workflow speed=\"3\"/>\n<environment\n tolerance=\"1\"/></msml>"),
            "s.xml:1: msml has no attribute colour\ns.xml:2: workflow has no attribute speed\n"
            "s.xml:4: environment has no attribute tolerance; it has units");
}

TEST(Structure, EnvironmentIsCheckedWithoutAnObject) {
  EXPECT_EQ(faults_of("<msml><environment>\n<solver tolerance=\"2\"/></environment></msml>"),
            "s.xml:2: tolerance = 2 is not in (0, 1)");
}

TEST(Structure, EnvironmentFaultsAppearOnceForTwoObjects) {
  std::string two = object({.environment = "<solver tolerance=\"2\" speed=\"1\"/>"});
  const std::size_t start = two.find("<object"), end = two.find("</object>") + 9;
  std::string second = two.substr(start, end - start);
  second.replace(second.find("id=\"body\""), 9, "id=\"twin\"");
  second.replace(second.find("id=\"disp\""), 9, "id=\"twinDisp\"");
  two.insert(end, second);
  const std::string faults = faults_of(two);
  EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 1) << faults;
}

TEST(Structure, TagsNotAvailableYetAreRefused) {
  EXPECT_EQ(task_faults("<Later/>"), "s.xml:2: Later is not available yet: use Fill");
  EXPECT_EQ(faults_of(object({.constraint = "<springs/>"})),
            "s.xml:8: springs is not available yet: hold nodes with hold");
}

TEST(Structure, OldAttributesWithoutMeaningAreNotedOnly) {
  const Compilation result = tiny::compiled(
      "<msml xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:schemaLocation=\"a b\"><variables>\n"
      "<var name=\"a\" value=\"1\" type=\"int\" format=\"x\" role=\"fix\"/></variables><workflow>\n"
      "<MakeSurface name=\"m\" time=\"3\" radius=\"${a}\"/></workflow>\n"
      "<environment><solver hf3_chanceOfContact=\"1\" name=\"s\"/></environment></msml>");
  EXPECT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(tiny::lines(result.warnings), "");
  EXPECT_EQ(tiny::lines(result.notes),
            "s.xml:1: xsi:schemaLocation of msml is accepted, but has no meaning\n"
            "s.xml:2: type of var is accepted, but has no meaning\n"
            "s.xml:2: format of var is accepted, but has no meaning\n"
            "s.xml:3: name of MakeSurface is accepted, but has no meaning\n"
            "s.xml:3: time of MakeSurface is accepted, but has no meaning\n"
            "s.xml:4: hf3_chanceOfContact of solver is accepted, but has no meaning\n"
            "s.xml:4: name of solver is accepted, but has no meaning");
}

TEST(Structure, RoleOfAVariableIsOneOfFour) {
  EXPECT_EQ(faults_of("<msml><variables>\n<var name=\"a\" value=\"1\" role=\"imput\"/></variables></msml>"),
            "s.xml:2: role = imput is not one of input, output, param, fix (did you mean 'input'?)");
}

}  // namespace
}  // namespace msml
