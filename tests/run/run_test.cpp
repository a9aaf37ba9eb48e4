// SPDX-License-Identifier: GPL-3.0-or-later
// Running small graphs of made-up operators.
#include "msml/run/run.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "msml/run/report.hpp"
#include "tests/compile/objects.hpp"
#include "tests/content.hpp"

namespace msml {
namespace {

using testing::content;
using tiny::Folder;
using tiny::object;
using tiny::workflow;

/// Remembers what it is told.
struct Listener : Watcher {
  std::mutex mutex;
  std::vector<std::string> texts;
  void say(const std::string& text) {
    const std::lock_guard lock(mutex);
    texts.push_back(text);
  }
  void started(int) override {}
  void progress(int, double, const std::string&) override {}
  void finished(int, const NodeReport&) override {}
  void note(int, const std::string& text) override { say("note " + text); }
  void warning(int, const std::string& text) override { say("warning " + text); }
  void print(int, const std::string& text) override { say(text); }
};

struct Ran {
  Compilation compilation;
  Plan plan;
  RunResult result;
  std::vector<std::string> texts;
  std::string error() const { return result.errors.empty() ? "" : result.errors.front().str(); }
};

/// Compiles and runs; `requested` are ids of tasks that nothing else asks for.
Ran ran(const std::string& text, const Registry& registry, const Folder& folder,
        std::vector<std::string> requested = {}, int jobs = 1) {
  Ran out;
  out.compilation = compile_text(text, (folder.path() / "s.xml").string(), registry,
                                 {.set = {}, .output_folder = folder.path() / "out", .strict = false});
  EXPECT_EQ(tiny::lines(out.compilation.faults), "");
  out.plan = make_plan(out.compilation.graph, requested);
  Listener listener;
  out.result = run(out.compilation.graph, out.plan, registry, {folder.path() / "out", jobs, 1}, listener);
  out.texts = listener.texts;
  return out;
}

/// The small language and one more task <Act/> with an optional mesh `after`, a number `x` and a mesh.
Registry with_act(std::function<void(Context&, Key<Mesh>, Key<double>)> act) {
  Registry registry = tiny::registry();
  Operator op("Act", "Do as the test says.");
  op.input<Mesh>("after", "what comes before", true);
  const auto mesh = op.output<Mesh>("mesh", "a mesh");
  const auto number = op.output<double>("x", "a number");
  op.target("file", mesh, "where it is written");
  op.run([=](Context& c) { act(c, mesh, number); });
  registry.add(std::move(op));
  return registry;
}

TEST(Run, WritesTargetsAndReportsEachNode) {
  const Folder folder;
  const Registry registry = tiny::registry();
  const Ran out = ran(workflow("<MakeSurface id=\"s\" file=\"sub/s.tri\"/>"
                               "<Fill id=\"f\" surfaceMesh=\"${s}\" cellSize=\"1\" meshFilename=\"f.tet\"/>"),
                      registry, folder);
  EXPECT_EQ(out.error(), "");
  EXPECT_EQ(content(folder.path() / "out/sub/s.tri"), "tri");
  EXPECT_EQ(content(folder.path() / "out/f.tet"), "tet");
  EXPECT_EQ(out.result.nodes.at(1).status, NodeStatus::done);
  EXPECT_EQ(out.result.nodes.at(1).summary, "4 points, 1 tet4");
  EXPECT_GT(out.result.nodes.at(1).output_bytes, 4 * 3 * sizeof(double));
}

TEST(Run, IndependentNodesRunAtTheSameTime) {
  const Folder folder;
  std::mutex mutex;
  std::condition_variable met;
  int inside = 0;
  bool together = false;
  const Registry registry = with_act([&](Context& c, Key<Mesh> mesh, Key<double>) {
    std::unique_lock lock(mutex);
    together = ++inside == 2 || together;
    met.notify_all();
    met.wait_for(lock, std::chrono::seconds(10), [&] { return together; });
    c.set(mesh, tiny::one_tet());
  });
  const Ran out =
      ran(workflow("<Act id=\"a\" file=\"a.tet\"/><Act id=\"b\" file=\"b.tet\"/>"), registry, folder, {}, 2);
  EXPECT_EQ(out.error(), "");
  EXPECT_TRUE(together);
}

TEST(Run, OneJobRunsOneNodeAtATimeInSceneOrder) {
  const Folder folder;
  std::vector<std::string> order;
  const Registry registry = with_act([&](Context& c, Key<Mesh> mesh, Key<double>) {
    order.push_back(c.args().id);
    c.set(mesh, tiny::one_tet());
  });
  ran(workflow("<Act id=\"c\" after=\"${b}\" file=\"c.tet\"/><Act id=\"a\" file=\"a.tet\"/><Act id=\"b\"/>"), registry,
      folder);
  EXPECT_EQ(order, (std::vector<std::string>{"a", "b", "c"}));
}

TEST(Run, FailureStopsWhatComesAfterAndNamesNodeAndLine) {
  const Folder folder;
  const Registry registry = tiny::registry();
  const Ran out =
      ran(workflow("<MakeSurface id=\"s\" file=\"s.tri\"/>\n<Fill id=\"f\" surfaceMesh=\"${s}\" cellSize=\"101\"/>"
                   "\n<Skin id=\"k\" mesh=\"${f}\" file=\"k.tri\"/>"),
          registry, folder);
  EXPECT_EQ(out.error(), (folder.path() / "s.xml").string() + ":3: Fill 'f': the surface is open: 12 edges are free");
  EXPECT_EQ(out.result.errors.front().failure(), Failure::input);
  EXPECT_EQ(out.result.nodes.at(0).status, NodeStatus::done);
  EXPECT_EQ(out.result.nodes.at(1).status, NodeStatus::failed);
  EXPECT_EQ(out.result.nodes.at(2).status, NodeStatus::waiting);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/s.tri"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/k.tri"));
}

TEST(Run, FailureKeepsItsKind) {
  const Folder folder;
  const Registry registry = with_act(
      [](Context&, Key<Mesh>, Key<double>) { throw Error("step 3 did not converge", {}, Failure::not_converged); });
  const Ran out = ran(workflow("<Act id=\"a\" file=\"a.tet\"/>"), registry, folder);
  ASSERT_EQ(out.result.errors.size(), 1u);
  EXPECT_EQ(static_cast<int>(out.result.errors[0].failure()), 3);
}

TEST(Run, StandardExceptionsBecomeInternalErrorsButForWantOfMemory) {
  const Folder folder;
  const auto thrown = [&](auto exception, int code) {
    const Registry registry = with_act([=](Context&, Key<Mesh>, Key<double>) { throw exception; });
    const Ran out = ran(workflow("<Act id=\"a\" file=\"a.tet\"/>"), registry, folder);
    EXPECT_EQ(static_cast<int>(out.result.errors.at(0).failure()), code);
    return std::string(out.result.errors.at(0).what());
  };
  EXPECT_EQ(thrown(std::runtime_error("index 7"), 4), "Act 'a': unexpected: index 7");
  EXPECT_EQ(thrown(std::bad_alloc(), 3), "Act 'a': not enough memory");
  const std::error_code no_thread = std::make_error_code(std::errc::resource_unavailable_try_again);
  EXPECT_EQ(thrown(std::system_error(no_thread), 3), "Act 'a': not enough memory for another thread; try --threads 1");
  EXPECT_EQ(thrown(std::system_error(std::make_error_code(std::errc::io_error), "disk"), 4),
            "Act 'a': unexpected: disk: Input/output error");
  EXPECT_EQ(thrown(42, 4), "Act 'a': unexpected failure without a message");
}

TEST(Run, ResultThatIsNotFiniteIsRefused) {
  const Folder folder;
  const Registry number = with_act([](Context& c, Key<Mesh>, Key<double> x) { c.set(x, std::nan("")); });
  EXPECT_EQ(std::string(ran(workflow("<Act id=\"a\" file=\"a.tet\"/>"), number, folder).result.errors.at(0).what()),
            "Act 'a': the result is not a finite number");
  const Registry field = with_act([](Context& c, Key<Mesh> mesh, Key<double>) {
    Mesh bad = tiny::one_tet();
    bad.point_fields.push_back({"stress", 1, {0, 0, std::numeric_limits<double>::infinity(), 0}});
    c.set(mesh, std::move(bad));
  });
  EXPECT_EQ(std::string(ran(workflow("<Act id=\"a\" file=\"a.tet\"/>"), field, folder).result.errors.at(0).what()),
            "Act 'a': value 2 of the field stress is not a finite number");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/a.tet"));
}

TEST(Run, ValueOnAnEdgeMustLieInTheRangeToo) {
  const Folder folder;
  const Registry registry = with_act([](Context& c, Key<Mesh>, Key<double> x) { c.set(x, -2.5); });
  const Ran out =
      ran(workflow("<Act id=\"a\"/>\n<MakeSurface id=\"s\"\n radius=\"${a.x}\" file=\"s.tri\"/>"), registry, folder);
  EXPECT_EQ(out.error(), (folder.path() / "s.xml").string() + ":4: MakeSurface 's': radius = -2.5 is not > 0");
}

TEST(Run, OutputThatWasNotGivenIsNamed) {
  const Folder folder;
  const Registry registry = with_act([](Context&, Key<Mesh>, Key<double>) {});
  const Ran out = ran(workflow("<Act id=\"a\"/>\n<Skin id=\"k\" mesh=\"${a}\" file=\"k.tri\"/>"), registry, folder);
  EXPECT_EQ(std::string(out.result.errors.at(0).what()), "Skin 'k': mesh: Act 'a' gave no mesh");
}

TEST(Run, ValuesAreReleasedAfterTheirLastUse) {
  const Folder folder;
  std::vector<std::weak_ptr<const Mesh>> made;
  std::vector<int> alive;
  const Registry registry = with_act([&](Context& c, Key<Mesh> mesh, Key<double>) {
    int count = 0;
    for (const auto& each : made) count += !each.expired();
    alive.push_back(count);
    auto fresh = std::make_shared<const Mesh>(tiny::one_tet());
    made.push_back(fresh);
    c.set(mesh, std::move(fresh));
  });
  const Ran out = ran(workflow("<Act id=\"a\"/><Act id=\"b\" after=\"${a}\"/><Act id=\"c\" after=\"${b}\"/>"
                               "<Act id=\"d\" after=\"${c}\" file=\"d.tet\"/>"),
                      registry, folder);
  EXPECT_EQ(out.error(), "");
  EXPECT_EQ(alive, (std::vector<int>{0, 1, 1, 1}));
  for (const auto& each : made) EXPECT_TRUE(each.expired());
}

TEST(Run, FilesAreHandedOnFromDiskTargetsAndSeries) {
  const Folder folder;
  folder.add("in.txt", "words");
  const Registry registry = tiny::registry();
  EXPECT_EQ(ran(workflow("<Copy id=\"a\" from=\"in.txt\" to=\"a.txt\"/><Copy id=\"b\" from=\"${a}\" to=\"b.txt\"/>"
                         "<MakeSurface id=\"s\" file=\"s.tri\"/><Copy id=\"c\" from=\"${s}\" to=\"c.any\"/>"),
                registry, folder)
                .error(),
            "");
  EXPECT_EQ(content(folder.path() / "out/b.txt"), "words");
  EXPECT_EQ(content(folder.path() / "out/c.any"), "tri");
  EXPECT_EQ(ran(object({.tasks = "<Copy id=\"last\" from=\"${disp}\" to=\"last.tet\"/>"}), registry, folder).error(),
            "");
  EXPECT_EQ(content(folder.path() / "out/last.tet"), "tet");
}

TEST(Run, SeriesWithAPatternTargetIsTakenStateByState) {
  const Folder folder;
  const Registry registry = tiny::registry();
  const Ran out = ran(object({.tasks = "<Skin id=\"k\" mesh=\"${disp}\" file=\"k_*.tri\"/>"}), registry, folder);
  EXPECT_EQ(out.error(), "");
  for (const char* name : {"k_0000.tri", "k_0001.tri", "k_0002.tri"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / name)) << name;
  EXPECT_EQ(out.result.nodes.at(0).files.size(), 3u);
}

TEST(Run, PatternGathersImagesAndReportsPrint) {
  const Folder folder;
  for (const char* name : {"a1.img", "a2.img", "a3.img"}) folder.add(name);
  const Registry registry = tiny::registry();
  const Ran out = ran(workflow("<Sum id=\"t\" image=\"a*.img\"/><MakeSurface id=\"s\" count=\"${t.count}\"/>"
                               "<Measure mesh=\"${s}\"/>"),
                      registry, folder, {"t"});
  EXPECT_EQ(out.error(), "");
  EXPECT_EQ(out.texts, std::vector<std::string>{"cells: 1"});
}

TEST(Run, SolidDeclaredAsSurfaceIsOneWarning) {
  const Folder folder;
  folder.add("m.tet");
  const Registry registry = tiny::registry();
  const Ran out = ran(tiny::with_variables("<var name=\"v\" value=\"m.tet\" logical=\"TriangularSurface\"/>",
                                           "<Skin id=\"a\" mesh=\"${v}\" file=\"a.tri\"/><Measure mesh=\"${v}\"/>"),
                      registry, folder);
  EXPECT_EQ(out.error(), "");
  EXPECT_EQ(out.texts.at(0),
            "warning m.tet is declared as TriangularSurface, but holds 4 points, 1 tet4; the file wins");
  EXPECT_EQ(out.texts.size(), 2u);
}

TEST(Run, TargetThatIsAFolderIsRefused) {
  const Folder folder;
  folder.add("out/s.tri/x");
  const Registry registry = tiny::registry();
  const Ran out = ran(workflow("<MakeSurface id=\"s\" file=\"s.tri\"/>"), registry, folder);
  const std::string message = out.result.errors.at(0).what();
  EXPECT_NE(message.find("MakeSurface 's': cannot write"), std::string::npos) << message;
  EXPECT_NE(message.find("directory"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/s.tri/x"));
}

TEST(Run, ReportIsJsonWithNodesErrorsAndFacts) {
  const Folder folder;
  const Registry registry = with_act([](Context& c, Key<Mesh> mesh, Key<double>) {
    c.reporter().record("check", "{\"residual\": 1e-9}");
    c.reporter().record("broken", "{no json");
    c.reporter().warn("mind this");
    c.set(mesh, tiny::one_tet());
  });
  const Ran out = ran(workflow("<Act id=\"a\" file=\"a.tet\"/><MakeSurface id=\"unused\"/>"), registry, folder);
  const auto json = nlohmann::json::parse(report_json(out.compilation.graph, out.plan, out.result, {}));
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["nodes"][0]["id"], "a");
  EXPECT_EQ(json["nodes"][0]["check"]["residual"], 1e-9);
  EXPECT_EQ(json["nodes"][0]["broken"], "{no json");
  EXPECT_EQ(json["nodes"][0]["warnings"][0], "mind this");
  EXPECT_EQ(json["notRun"][0], "unused");
  EXPECT_TRUE(json["errors"].empty());
  const std::string table = summary_table(out.compilation.graph, out.plan, out.result);
  EXPECT_NE(table.find("4 points, 1 tet4"), std::string::npos) << table;
}

TEST(Run, ManyNodesOnManyWorkersAllRunOnce) {
  const Folder folder;
  std::mutex mutex;
  std::multiset<std::string> seen;
  const Registry registry = with_act([&](Context& c, Key<Mesh> mesh, Key<double>) {
    {
      const std::lock_guard lock(mutex);
      seen.insert(c.args().id);
    }
    c.set(mesh, tiny::one_tet());
  });
  std::string tasks = "<Act id=\"t0\"/>";
  for (int i = 1; i < 300; ++i)
    tasks += "<Act id=\"t" + std::to_string(i) + "\" after=\"${t" + std::to_string(i / 2) + "}\"/>";
  std::vector<std::string> all;
  for (int i = 0; i < 300; ++i) all.push_back("t" + std::to_string(i));
  EXPECT_EQ(ran(workflow(tasks), registry, folder, all, 8).error(), "");
  EXPECT_EQ(seen.size(), 300u);
  EXPECT_EQ(std::set<std::string>(seen.begin(), seen.end()).size(), 300u);
}

}  // namespace
}  // namespace msml
