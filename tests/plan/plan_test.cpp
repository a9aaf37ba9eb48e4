// SPDX-License-Identifier: GPL-3.0-or-later
// What runs, and what does not.
#include "msml/plan/plan.hpp"

#include <gtest/gtest.h>

#include "tests/compile/objects.hpp"

namespace msml {
namespace {

using tiny::compiled;
using tiny::object;
using tiny::workflow;

std::vector<std::string> ids(const Graph& graph, const std::vector<int>& nodes) {
  std::vector<std::string> all;
  for (const int i : nodes) all.push_back(graph.nodes.at(static_cast<std::size_t>(i)).id);
  return all;
}
using Ids = std::vector<std::string>;

constexpr const char* chain =
    "<MakeSurface id=\"s\"/><Fill id=\"f\" surfaceMesh=\"${s}\" cellSize=\"1\"/>"
    "<Skin id=\"k\" mesh=\"${f}\"/>";

TEST(Plan, WithoutOutputsNothingRuns) {
  const Compilation result = compiled(workflow(chain));
  const Plan plan = make_plan(result.graph);
  EXPECT_EQ(ids(result.graph, plan.order), Ids{});
  EXPECT_EQ(ids(result.graph, plan.skipped), (Ids{"s", "f", "k"}));
}

TEST(Plan, RequestRunsATaskAndWhatItNeeds) {
  const Compilation result = compiled(workflow(chain));
  const Plan plan = make_plan(result.graph, {"f"});
  EXPECT_EQ(ids(result.graph, plan.order), (Ids{"s", "f"}));
  EXPECT_EQ(ids(result.graph, plan.skipped), Ids{"k"});
  EXPECT_EQ(plan.runs, (std::vector<bool>{true, true, false}));
}

TEST(Plan, RequestOfAnUnknownIdIsRefusedWithTheNearest) {
  const Compilation result = compiled(workflow("<MakeSurface id=\"liver\"/>"));
  try {
    make_plan(result.graph, {"livre"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "--request livre: the scene has no task or output of that name (did you mean 'liver'?)");
  }
}

TEST(Plan, FileTargetsReportsAndSceneOutputsRun) {
  const Compilation written = compiled(workflow("<MakeSurface id=\"a\" file=\"a.tri\"/><MakeSurface id=\"b\"/>"));
  EXPECT_EQ(ids(written.graph, make_plan(written.graph).order), Ids{"a"});
  const Compilation report = compiled(workflow("<MakeSurface id=\"a\"/><Measure id=\"m\" mesh=\"${a}\"/>"));
  EXPECT_EQ(ids(report.graph, make_plan(report.graph).order), (Ids{"a", "m"}));
  const Compilation scene = compiled(object({.tasks = "<Skin id=\"unused\" mesh=\"${disp}\"/>"}));
  const Plan plan = make_plan(scene.graph);
  EXPECT_EQ(ids(scene.graph, plan.order), (Ids{"s", "m", "r", "body"}));
  EXPECT_EQ(ids(scene.graph, plan.skipped), Ids{"unused"});
}

TEST(Plan, RequestOfASceneOutputRunsItsSimulation) {
  const Compilation scene = compiled(object({}));
  EXPECT_EQ(ids(scene.graph, make_plan(scene.graph, {"disp"}).order), (Ids{"s", "m", "r", "body"}));
}

TEST(Plan, DescriptionSaysWhatRunsWhatIsWrittenAndWhatDoesNot) {
  const Compilation result =
      compiled(workflow("<MakeSurface id=\"a\" file=\"a.tri\"/>\n"
                        "<Fill id=\"b\" surfaceMesh=\"${a}\" cellSize=\"1\" meshFilename=\"b.tet\"/>\n"
                        "<MakeSurface id=\"c\"/>"));
  EXPECT_EQ(describe(result.graph, make_plan(result.graph)),
            "[1/2] MakeSurface  a     writes a.tri\n"
            "[2/2] Fill         b     from a  writes b.tet\n"
            "does not run: MakeSurface c (line 4): no output, file target or request needs it\n");
}

TEST(Plan, LongChainNeedsNoDeepStack) {
  std::string tasks = "<MakeSurface id=\"t0\"/>";
  for (int i = 1; i < 100'000; ++i)
    tasks += "<Skin id=\"t" + std::to_string(i) + "\" mesh=\"${t" + std::to_string(i - 1) + "}\"/>\n";
  const Compilation result = compiled(workflow(tasks));
  EXPECT_EQ(make_plan(result.graph, {"t99999"}).order.size(), 100'000u);
}

}  // namespace
}  // namespace msml
