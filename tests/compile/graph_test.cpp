// SPDX-License-Identifier: GPL-3.0-or-later
// Files, patterns, steps, order, cycles, nested tasks: how the graph comes about.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/compile/objects.hpp"

namespace msml {
namespace {

using tiny::compiled;
using tiny::faults_of;
using tiny::Folder;
using tiny::object;
using tiny::task_faults;
using tiny::workflow;

/// Ids of the nodes in the order in which they run.
std::vector<std::string> order_of(const Compilation& result) {
  std::vector<std::string> ids;
  for (const int i : result.graph.order) ids.push_back(result.graph.nodes.at(static_cast<std::size_t>(i)).id);
  return ids;
}

TEST(Files, MissingFileShowsTheNearest) {
  const Folder folder;
  folder.add("liver.tri");
  EXPECT_EQ(task_faults("<Fill surfaceMesh=\"livre.tri\" cellSize=\"1\"/>", {}, folder.path()),
            "s.xml:2: surfaceMesh = livre.tri names no file beside the scene and no task's target (did you mean "
            "'liver.tri'?)");
}

TEST(Files, FolderWhereAFileIsNeededIsAFault) {
  const Folder folder;
  folder.add("data.tri/x");
  EXPECT_EQ(task_faults("<Fill surfaceMesh=\"data.tri\" cellSize=\"1\"/>", {}, folder.path()),
            "s.xml:2: surfaceMesh = data.tri is a folder, not a file");
}

TEST(Files, FileOfAnotherKindIsAFault) {
  const Folder folder;
  folder.add("scan.img");
  EXPECT_EQ(task_faults("<Fill surfaceMesh=\"scan.img\" cellSize=\"1\"/>", {}, folder.path()),
            "s.xml:2: surfaceMesh = scan.img cannot be read as a Surface: such files end in .tri");
}

TEST(Files, EmptyOrEndlessNamesAreFaults) {
  EXPECT_EQ(task_faults("<Skin mesh=\"\"/>"), "s.xml:2: mesh is empty, but names a file");
  EXPECT_EQ(task_faults("<Skin mesh=\"" + std::string(5000, 'a') + "\"/>"),
            "s.xml:2: mesh = " + std::string(60, 'a') + "… is too long for a file name");
}

TEST(Files, FileIsReadOncePerTypeAndLookedUpBesideTheScene) {
  const Folder folder;
  folder.add("sub/a.tri");
  const Compilation result = compiled(workflow("<Fill id=\"f\" surfaceMesh=\"sub/a.tri\" cellSize=\"1\"/>"
                                               "<Voxelize id=\"v\" surface=\"sub/../sub/a.tri\"/>"),
                                      {}, folder.path());
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(order_of(result), (std::vector<std::string>{"a.tri", "f", "v"}));
}

TEST(Files, NameOfAnotherTasksTargetIsAnEdge) {
  const Compilation result =
      compiled(workflow("<Fill id=\"f\" surfaceMesh=\"./skin.tri\" cellSize=\"1\"/>"
                        "<MakeSurface id=\"s\" file=\"skin.tri\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(order_of(result), (std::vector<std::string>{"s", "f"}));
}

TEST(Files, TargetOfUnknownExtensionIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"s\" file=\"skin.xyz\"/>"),
            "s.xml:2: file = skin.xyz: files that hold a Surface end in .tri");
  EXPECT_EQ(task_faults("<MakeSurface id=\"s\" file=\"skin.tet\"/>"),
            "s.xml:2: file = skin.tet: files that hold a Surface end in .tri");
}

TEST(Files, TwoTasksMayNotWriteOneFile) {
  EXPECT_EQ(task_faults("<MakeSurface file=\"a.tri\"/>\n<MakeSurface file=\"./a.tri\"/>"),
            "s.xml:3: file = ./a.tri is also written at line 2");
}

TEST(Files, OutputMayNotOverwriteAnInput) {
  const Folder folder;
  folder.add("a.tet");
  folder.add("b.txt");
  const CompileOptions below{.output_folder = folder.path() / "out"};
  EXPECT_EQ(task_faults("<Skin id=\"s\" mesh=\"a.tet\"/>\n<Fill surfaceMesh=\"${s}\" cellSize=\"1\"\n"
                        " meshFilename=\"../a.tet\"/>",
                        below, folder.path()),
            "s.xml:4: ../a.tet would overwrite the input of the same name; choose another output folder with -o");
  EXPECT_EQ(task_faults("<Copy from=\"b.txt\" to=\"../b.txt\"/>", below, folder.path()),
            "s.xml:2: ../b.txt would overwrite the input of the same name; choose another output folder with -o");
  EXPECT_EQ(task_faults("<Copy from=\"b.txt\" to=\"../s.xml\"/>", below, folder.path()),
            "s.xml:2: ../s.xml would overwrite the scene itself");
}

TEST(Cycles, OfOneTaskIsAFault) {
  EXPECT_EQ(task_faults("<Fill id=\"a\" surfaceMesh=\"${b}\" cellSize=\"1\"/>\n<Skin id=\"b\" mesh=\"${b}\"/>"),
            "s.xml:3: tasks that need each other in a circle: b (line 3) needs b (line 3)");
}

TEST(Cycles, OfTwoTasksPrintsItsPath) {
  EXPECT_EQ(task_faults("<Fill id=\"a\" surfaceMesh=\"${b}\" cellSize=\"1\"/>\n<Skin id=\"b\" mesh=\"${a}\"/>"),
            "s.xml:2: tasks that need each other in a circle: a (line 2) needs b (line 3) needs a (line 2)");
}

TEST(Cycles, OfThreeTasksBesideOthersPrintsItsPathAlone) {
  EXPECT_EQ(task_faults("<Skin id=\"user\" mesh=\"${a}\"/>\n<Fill id=\"a\" surfaceMesh=\"${b}\" cellSize=\"1\"/>\n"
                        "<Skin id=\"b\" mesh=\"${c}\"/>\n<Skin id=\"c\" mesh=\"${a}\"/>\n<MakeSurface id=\"free\"/>"),
            "s.xml:3: tasks that need each other in a circle: a (line 3) needs b (line 4) needs c (line 5) needs a "
            "(line 3)");
}

TEST(Cycles, ThroughFilesAndObjectsAreFound) {
  EXPECT_EQ(task_faults("<Fill id=\"a\" surfaceMesh=\"b.tri\" meshFilename=\"a.tet\" cellSize=\"1\"/>\n"
                        "<Skin id=\"b\" mesh=\"a.tet\" file=\"b.tri\"/>"),
            "s.xml:2: tasks that need each other in a circle: a (line 2) needs b (line 3) needs a (line 2)");
  EXPECT_EQ(faults_of(object({.mesh = "<linearTet mesh=\"${x}\"/>", .tasks = "<Skin id=\"x\" mesh=\"${disp}\"/>"})),
            "s.xml:17: tasks that need each other in a circle: x (line 17) needs body (line 2) needs x (line 17)");
}

TEST(Cycles, AreReportedBesideOtherFaults) {
  EXPECT_EQ(task_faults("<Skin id=\"b\" mesh=\"${b}\"/>\n<MakeSurface radius=\"0\"/>"),
            "s.xml:2: tasks that need each other in a circle: b (line 2) needs b (line 2)\n"
            "s.xml:3: radius = 0 is not > 0");
}

TEST(Patterns, TaskRunsOncePerFileInNaturalOrder) {
  const Folder folder;
  for (const char* name : {"s10.tri", "s2.tri", "s1.tri", "t.tri", "s3.img"}) folder.add(name);
  const Compilation result = compiled(
      workflow("<Fill id=\"f\" surfaceMesh=\"s*.tri\" meshFilename=\"m_*.tet\" cellSize=\"1\"/>"), {}, folder.path());
  ASSERT_EQ(tiny::lines(result.faults), "");
  std::vector<std::string> ids, targets;
  for (const Node& node : result.graph.nodes)
    if (node.kind == NodeKind::task) ids.push_back(node.id), targets.push_back(node.targets.at(0).file.string());
  EXPECT_EQ(ids, (std::vector<std::string>{"f[1]", "f[2]", "f[10]"}));
  EXPECT_EQ(targets, (std::vector<std::string>{"m_1.tet", "m_2.tet", "m_10.tet"}));
}

TEST(Patterns, OfTasksInAChainMayStandInAnyOrder) {
  const Folder folder;
  folder.add("s1.tri");
  folder.add("s2.tri");
  const Compilation result =
      compiled(workflow("<Skin id=\"k\" mesh=\"*.fine.tet\" file=\"*.out.tri\"/>"
                        "<Fill id=\"f\" surfaceMesh=\"s*.tri\" meshFilename=\"m*.fine.tet\" cellSize=\"1\"/>"),
               {}, folder.path());
  ASSERT_EQ(tiny::lines(result.faults), "");
  std::vector<std::string> files;
  for (const Node& node : result.graph.nodes)
    if (node.op && node.op->tag() == "Skin") files.push_back(node.targets.at(0).file.string());
  EXPECT_EQ(files, (std::vector<std::string>{"m1.out.tri", "m2.out.tri"}));
}

TEST(Patterns, WithoutAMatchAreAFault) {
  EXPECT_EQ(task_faults("<Fill surfaceMesh=\"s*.tri\" meshFilename=\"m_*.tet\" cellSize=\"1\"/>"),
            "s.xml:2: surfaceMesh = s*.tri matches no file beside the scene and no task's target");
  EXPECT_EQ(task_faults("<Sum image=\"a*.img\"/>"),
            "s.xml:2: image = a*.img matches no file beside the scene and no task's target");
}

TEST(Patterns, TargetWithoutStarIsOneFileForAll) {
  const Folder folder;
  folder.add("s1.tri");
  folder.add("s2.tri");
  EXPECT_EQ(
      task_faults("<Fill surfaceMesh=\"s*.tri\"\n meshFilename=\"m.tet\" cellSize=\"1\"/>", {}, folder.path()),
      "s.xml:3: meshFilename = m.tet is one file, but the task runs once per file that matches surfaceMesh; put a "
      "* into it");
}

TEST(Patterns, TargetAloneIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"s\" file=\"m_*.tri\"/>"),
            "s.xml:2: m_*.tri is a pattern, but no input of MakeSurface 's' is a pattern or a series");
}

TEST(Patterns, TaskPerFileWhereOneValueIsNeededIsAFault) {
  const Folder folder;
  folder.add("s1.tri");
  folder.add("s2.tri");
  const std::string fill = "<Fill id=\"f\" surfaceMesh=\"s*.tri\" cellSize=\"1\"/>\n";
  EXPECT_EQ(task_faults(fill + "<Skin mesh=\"${f}\"/>", {}, folder.path()),
            "s.xml:3: mesh of Skin takes one Mesh, but ${f} runs once per file and gives 2");
  EXPECT_EQ(task_faults("<Skin>\n<Fill id=\"f\" surfaceMesh=\"s*.tri\" cellSize=\"1\"/></Skin>", {}, folder.path()),
            "s.xml:3: mesh of Skin takes one Mesh, but ${f[1]} runs once per file and gives 2");
}

TEST(Patterns, OfOtherTasksTargetsGatherTheirValues) {
  const Compilation result =
      compiled(workflow("<Sum id=\"sum\" image=\"a*.img\"/><MakeSurface id=\"s\"/>"
                        "<Voxelize id=\"v10\" surface=\"${s}\" imageFile=\"a10.img\"/>"
                        "<Voxelize id=\"v9\" surface=\"${s}\" imageFile=\"a9.img\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  const auto edges = std::get<std::vector<Edge>>(result.graph.nodes.at(0).args.sources.at(0));
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(result.graph.nodes.at(static_cast<std::size_t>(edges[0].node)).id, "v9");
  EXPECT_EQ(order_of(result), (std::vector<std::string>{"s", "v10", "v9", "sum"}));
}

TEST(Nested, TasksFeedUnsetInputsInOrder) {
  const Compilation result = compiled(
      workflow("<Skin id=\"outer\"><Fill id=\"middle\" cellSize=\"1\"><MakeSurface id=\"inner\"/></Fill></Skin>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(order_of(result), (std::vector<std::string>{"inner", "middle", "outer"}));
}

TEST(Nested, TaskWithoutAnInputLeftIsAFault) {
  EXPECT_EQ(task_faults("<MakeSurface id=\"s\"/><Skin id=\"k\" mesh=\"${s}\">\n<MakeSurface/></Skin>"),
            "s.xml:3: Skin 'k' has no unset input left for the nested MakeSurface");
}

TEST(Nested, TaskOfTheWrongTypeIsAFault) {
  EXPECT_EQ(task_faults("<Fill cellSize=\"1\">\n<Voxelize id=\"v\"><MakeSurface/></Voxelize></Fill>"),
            "s.xml:3: surfaceMesh of Fill needs a Surface, but ${v} is the Image 'image' of Voxelize at line 3");
}

TEST(Steps, UnknownStepIsAWarningThatListsThem) {
  const std::string text = object({.constraint = "<hold indices=\"0\" forStep=\"${puhs}\"/>"});
  const Compilation result = compiled(text);
  EXPECT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(tiny::lines(result.warnings),
            "s.xml:8: forStep = puhs names no step, so this never acts; the steps are push (did you mean 'push'?)");
  EXPECT_EQ(faults_of(text, {.strict = true}),
            "s.xml:8: forStep = puhs names no step, so this never acts; the steps are push (did you mean 'push'?)");
}

TEST(Steps, MayBeNamedWithOrWithoutBraces) {
  for (const char* name : {"push", "${push}", " ${ push } "}) {
    const Compilation result =
        compiled(object({.constraint = "<hold indices=\"0\" forStep=\"" + std::string(name) + "\"/>"}));
    EXPECT_EQ(tiny::lines(result.faults) + tiny::lines(result.warnings), "") << name;
  }
}

TEST(Steps, StepOfASceneWithoutStepsIsAWarning) {
  EXPECT_EQ(tiny::lines(compiled(object({.environment = ""})).warnings),
            "s.xml:8: forStep = push names no step, so this never acts; no step of the scene has a name");
}

TEST(Units, TheirLabelReachesTheGraph) {
  EXPECT_EQ(compiled("<msml>\n<environment units=\"mm N s MPa\"/>\n</msml>").graph.units, "mm N s MPa");
}

TEST(Steps, NamesOfStepsDiffer) {
  EXPECT_EQ(faults_of(object({.environment = "<simulation><step name=\"push\"/>\n<step name=\"push\"/></simulation>"})),
            "s.xml:16: two steps are named push");
}

TEST(Objects, BecomeOneNodeEach) {
  const Compilation result = compiled(object({}));
  ASSERT_EQ(tiny::lines(result.faults) + tiny::lines(result.warnings), "");
  const Node& node = result.graph.nodes.back();
  EXPECT_EQ(node.kind, NodeKind::simulation);
  EXPECT_EQ(node.id, "body");
  EXPECT_EQ(node.results, std::vector<std::string>{"disp"});
  EXPECT_EQ(node.output_type(0), Type::series);
  EXPECT_EQ(node.needs, (std::vector<int>{1, 2}));
  ASSERT_EQ(node.args.children.size(), 3u);
  EXPECT_EQ(node.args.children[2].description->tag(), "simulation");
}

TEST(Objects, GetADefaultStepAndSolver) {
  const Compilation result = compiled(object({.constraint = "<hold indices=\"0\"/>", .environment = ""}));
  ASSERT_EQ(tiny::lines(result.faults), "");
  const Binding& args = result.graph.nodes.back().args;
  EXPECT_EQ(args.children.at(1).description->tag(), "solver");
  EXPECT_EQ(args.children.at(2).children.at(0).description->tag(), "step");
}

TEST(Objects, OfOneNameAreAFault) {
  std::string two = object({});
  two.insert(two.find("</scene>"),
             "<object id=\"body\"><mesh><linearTet mesh=\"${m}\"/></mesh><material><region "
             "indices=\"${r}\"><softMaterial youngModulus=\"1\"/></region></material></object>");
  EXPECT_EQ(faults_of(two), "s.xml:13: two objects are called body: the other one is at line 2");
}

TEST(Objects, OutputUsedAsMeshIsItsLastState) {
  EXPECT_EQ(faults_of(object({.tasks = "<Skin mesh=\"${disp}\"/><Copy from=\"${disp}\" to=\"last.tet\"/>"})), "");
}

TEST(Objects, OutputWithAPatternTargetIsTakenStateByState) {
  const Compilation result = compiled(object({.tasks = "<Skin id=\"k\" mesh=\"${disp}\" file=\"k_*.tri\"/>"}));
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(result.graph.nodes.at(0).each_state, 0);
}

TEST(Faults, AllOfASceneAreReportedSortedByLine) {
  EXPECT_EQ(
      task_faults("<Skin mesh=\"${nobody}\"/>\n<MakeSurface radius=\"0\" angle=\"99\"/>\n<Banana/>\n"
                  "<MakeSurface>stray</MakeSurface>\n<Fill surfaceMesh=\"no.tri\" size=\"1\"/>"),
      "s.xml:2: ${nobody} names no variable, task or output\n"
      "s.xml:3: radius = 0 is not > 0\n"
      "s.xml:3: angle = 99 is not in [0, 30]\n"
      "s.xml:4: unknown tag Banana inside workflow; known there: MakeSurface, Fill, Skin, Pick, Paint, Voxelize, Sum, "
      "Copy, Measure, Later\n"
      "s.xml:5: text 'stray' inside MakeSurface has no meaning; values stand in attributes\n"
      "s.xml:6: surfaceMesh = no.tri names no file beside the scene and no task's target\n"
      "s.xml:6: Fill has no attribute size; it has surfaceMesh, cellSize, meshFilename\n"
      "s.xml:6: Fill needs the attribute cellSize: size of the cells");
}

TEST(Order, OfThousandTasksFollowsTheEdges) {
  std::string tasks;
  for (int i = 999; i > 0; --i)
    tasks += "<Skin id=\"t" + std::to_string(i) + "\" mesh=\"${t" + std::to_string(i - 1) + "}\"/>\n";
  const std::string text = workflow(tasks + "<MakeSurface id=\"t0\"/>");
  const auto start = std::chrono::steady_clock::now();
  const Compilation result = compiled(text);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", std::to_string(took.count()));
  std::printf("1000 tasks from text to graph: %.1f ms\n", took.count());
  ASSERT_EQ(tiny::lines(result.faults), "");
  const auto ids = order_of(result);
  ASSERT_EQ(ids.size(), 1000u);
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], "t" + std::to_string(i));
}

TEST(Order, OfHundredThousandTasksInAChainNeedsNoDeepStack) {
  std::string tasks = "<MakeSurface id=\"t0\"/>";
  for (int i = 1; i < 100'000; ++i)
    tasks += "<Skin id=\"t" + std::to_string(i) + "\" mesh=\"${t" + std::to_string(i - 1) + "}\"/>\n";
  const Compilation result = compiled(workflow(tasks));
  ASSERT_EQ(tiny::lines(result.faults), "");
  EXPECT_EQ(result.graph.order.size(), 100'000u);
}

TEST(Picture, NamesNodesEdgesAndFilesAndEscapesQuotes) {
  const Compilation result =
      compiled(workflow("<MakeSurface id=\"a&quot;b\" file=\"a.tri\"/><MakeSurface id=\"s\"/>"
                        "<Fill id=\"f\" surfaceMesh=\"${s}\" cellSize=\"1\"/>"));
  const std::string dot = to_dot(result.graph, {true, true, false});
  EXPECT_NE(dot.find("n1 -> n2 [label=\"surfaceMesh\\nSurface\"]"), std::string::npos) << dot;
  EXPECT_NE(dot.find("\"file a.tri\""), std::string::npos);
  EXPECT_NE(dot.find("style=dashed"), std::string::npos);
}

}  // namespace
}  // namespace msml
