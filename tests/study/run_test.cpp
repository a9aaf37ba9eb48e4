// SPDX-License-Identifier: GPL-3.0-or-later
// A scene with a study in, a table out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <fstream>
#include <new>
#include <set>
#include <thread>

#include "msml/study/extrapolate.hpp"
#include "msml/study/page.hpp"
#include "msml/study/runner.hpp"
#include "tests/commands/real_language.hpp"
#include "tests/study/bar.hpp"

namespace msml {
namespace {

using studies::bar;

struct Ran {
  Table table;
  Sharing sharing;
};

Ran run(const std::string& study, const tiny::Folder& folder, const Table& known = {}, const RowSink& sink = {},
        int jobs = 1) {
  std::vector<Fault> faults;
  const Document document = parse_document(bar(study), (folder.path() / "s.xml").string(), faults);
  const Compilation compilation = compile(document, real_language());
  EXPECT_EQ(tiny::lines(compilation.faults), "");
  const Study& first = compilation.studies.at(0);
  const auto runs = prepare_runs(document, real_language(), {}, first);
  Ran ran;
  const StudyOptions options{.folder = folder.path() / "out", .jobs = jobs};
  ran.table = run_study(
      first, runs, real_language(), options, known,
      [&](const Table& table, std::size_t row) {
        if (sink) sink(table, row);
      },
      ran.sharing);
  return ran;
}

TEST(StudyRun, AColumnUnderItsOwnWeightIsExactWithQuadraticElements) {
  const tiny::Folder folder;
  // nu = 0: u_z = -rho g (L Z - Z^2 / 2) / E, which quadratic elements hold exactly; the tip sinks by rho g L^2 / (2
  // E).
  const Ran ran =
      run(R"xml(<study id="s"> <vary variable="kind" values="tet4 tet10"/> <vary variable="n" values="2 4 8"/>
    <reference expression="0, 0, -0.01*(4*Z-Z^2/2)"/> <measure id="error" error="L2"/> <measure probe="tip" component="z"/>
    </study>)xml",
          folder);
  EXPECT_EQ(ran.table.columns, (std::vector<std::string>{"kind", "n", "status", "unknowns", "error", "tip_z",
                                                         "warnings", "recovered", "reason", "key"}));
  ASSERT_EQ(ran.table.rows.size(), 6U);
  for (std::size_t row = 0; row < 6; ++row) EXPECT_EQ(ran.table.text(row, "status"), "done");
  EXPECT_LT(ran.table.number(5, "error"), 1e-9);  // round-off of the solver
  EXPECT_NEAR(ran.table.number(5, "tip_z"), -0.08, 1e-10);
  EXPECT_EQ(ran.table.number(3, "unknowns"), 3 * (125 - 25));
  // Linear elements: order 2, so half the size gives a quarter of the error, within what coarse meshes allow.
  EXPECT_NEAR(ran.table.number(1, "error") / ran.table.number(2, "error"), 4, 1);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out" / "runs"));
  EXPECT_EQ(to_csv(read_csv(folder.path() / "out" / "results.csv")), to_csv(ran.table));
}

TEST(StudyRun, ErrorsAreTakenAgainstAnotherSetting) {
  const tiny::Folder folder;
  const Ran ran = run(R"(<study id="s"> <vary variable="n" values="1 2"/> <reference set="kind=tet10 n=2"/>
    <measure id="error" error="RMS"/> <measure id="tip_error" probe="tip" component="z" error="RMS"/></study>)",
                      folder);
  EXPECT_GT(ran.table.number(0, "error"), ran.table.number(1, "error"));
  EXPECT_GT(ran.table.number(1, "error"), 1e-3);
  EXPECT_LT(ran.table.number(1, "tip_error"), 0.2);
}

TEST(StudyRun, ErrorsAreTakenAgainstAFile) {
  const tiny::Folder folder;
  Mesh mesh;  // one node at the top, sunk by rho g L^2 / (2 E)
  mesh.points.resize(1, 3);
  mesh.points << 2, 2, 4 - 0.08;
  const int node = 0;
  mesh.add_cell(CellKind::vertex, &node);
  mesh.point_fields.push_back({"displacement", 3, {0, 0, -0.08}});
  real_language().write(Value{std::make_shared<const Mesh>(mesh)}, folder.path() / "top.vtu");
  const Ran ran = run(R"(<study id="s"> <vary variable="n" values="2"/> <vary variable="kind" values="tet10"/>
    <reference file="top.vtu"/> <measure id="error" error="maximum"/></study>)",
                      folder);
  EXPECT_EQ(ran.table.text(0, "reason"), "");
  EXPECT_LT(ran.table.number(0, "error"), 1e-9);  // exact with quadratic elements
}

TEST(StudyRun, ErrorsAreTakenAgainstTheLimitOfFinerSettings) {
  const tiny::Folder folder;
  const std::string study = R"(<study id="s"> <vary variable="n" values="2 4 8"/> <reference extrapolate="n"/>
    <measure id="tip" probe="tip" component="z" error="RMS"/></study>)";
  const Ran ran = run(study, folder);
  // Where sizes halve, Richardson's limit is that of Aitken's process.
  const auto value = [&](std::size_t row) { return ran.table.number(row, "tip_value"); };
  const double first = value(1) - value(0), second = value(2) - value(1);
  const double limit = value(2) - second * second / (second - first);
  EXPECT_NEAR(limit, -0.08, 2e-5);  // the exact value, met to a fourth of the last step
  for (std::size_t row = 0; row < 3; ++row)
    EXPECT_NEAR(ran.table.number(row, "tip"), std::abs(value(row) - limit) / std::abs(limit), 1e-7);  // ten digits
  EXPECT_GT(ran.table.number(0, "tip"), ran.table.number(1, "tip"));
  EXPECT_EQ(run(study, folder, ran.table).table.rows, ran.table.rows) << "rows of an earlier session";
}

TEST(StudyRun, EachSettingOfTheOtherVariablesHasItsLimit) {
  const tiny::Folder folder;
  // parts is refined along with n; E divides the runs: the tip sinks by rho g L^2 / (2 E), 0.08 and 0.04.
  const Ran ran = run(R"(<study id="s"> <vary variable="E" values="1000 2000"/>
    <vary variable="n parts" values="2 1; 4 2; 8 3"/> <reference extrapolate="n"/>
    <measure id="tip" probe="tip" component="z" error="RMS"/></study>)",
                      folder);
  for (std::size_t row = 0; row < 6; ++row) {
    const double exact = row < 3 ? -0.08 : -0.04, value = ran.table.number(row, "tip_value");
    // The limit meets the exact value to a fourth of the last step, 0.3 %.
    EXPECT_NEAR(ran.table.number(row, "tip"), std::abs(value - exact) / std::abs(exact), 3e-3) << row;
  }
  EXPECT_LT(ran.table.number(5, "tip"), ran.table.number(3, "tip"));
}

TEST(StudyRun, AMissingLimitIsExplained) {
  const tiny::Folder folder;
  // The exact elements give the same number on each mesh: no two differ, so nothing approaches anything.
  Ran ran = run(R"(<study id="s"> <vary variable="kind" values="tet4 tet10"/> <vary variable="n" values="2 4 8"/>
    <reference extrapolate="n"/> <measure id="tip" probe="tip" component="z" error="RMS"/></study>)",
                folder);
  EXPECT_GT(ran.table.number(0, "tip"), 0);
  Study study;
  study.vary = {{.variables = {"kind"}, .values = {}, .where = {}}, {.variables = {"n"}, .values = {}, .where = {}}};
  study.truth = Truth{.set = {}, .file = "", .expected = {}, .extrapolate = "n", .where = {}};
  study.measures = {{.id = "tip", .against_truth = true, .extrapolated = true, .where = {}}};
  for (std::size_t row = 3; row < 6; ++row)
    ran.table.rows[row][static_cast<std::size_t>(ran.table.find("tip_value"))] = "1";
  const auto without = extrapolate(study, ran.table);
  ASSERT_EQ(without.size(), 1U);
  EXPECT_EQ(without[0].others, "tet10");
  EXPECT_THAT(without[0].why, ::testing::HasSubstr("end with two that are equal"));
  bool told = false;
  for (const Block& block : make_page(study, ran.table, ""))
    for (const auto& row : block.cells) told = told || row.back() == without[0].why;
  EXPECT_TRUE(told) << "on the page too";
}

/// The language with a task that finds no memory for 2, and for 3 ends as a simulation whose factor does not fit.
const Registry& hungry_language() {
  static const Registry registry = [] {
    Registry all;
    add_grammar(all);
    add_operators(all);
    Operator op("Hungry", "A task that finds no memory for 2.");
    const auto number = op.parameter<Integer>("number", {.doc = "of bites"});
    const auto result = op.output<double>("result", "the number");
    op.run([=](Context& c) {
      if (c.get(number) == 2) throw std::bad_alloc();
      if (c.get(number) == 3) {
        c.reporter().record("check", R"({"ended": "out of memory"})");
        throw Error("the factor does not fit", {}, Failure::not_converged);
      }
      c.set(result, static_cast<double>(c.get(number)));
    });
    all.add(std::move(op));
    return all;
  }();
  return registry;
}

TEST(StudyRun, WantOfMemoryIsAStatusOfItsOwn) {
  const tiny::Folder folder;
  const Registry& language = hungry_language();
  std::vector<Fault> faults;
  const Document document = parse_document(
      R"(<msml><variables><var name="n" value="1"/></variables><workflow><Hungry id="eats" number="${n}"/></workflow>
      <studies><study id="s"><vary variable="n" values="1 2 3"/><measure value="eats"/></study></studies></msml>)",
      (folder.path() / "s.xml").string(), faults);
  const Compilation compilation = compile(document, language);
  ASSERT_EQ(tiny::lines(compilation.faults), "");
  Sharing sharing;
  const Table table = run_study(
      compilation.studies.at(0), prepare_runs(document, language, {}, compilation.studies.at(0)), language,
      {.folder = folder.path() / "out"}, {}, [](const Table&, std::size_t) {}, sharing);
  EXPECT_EQ(table.text(0, "status"), "done") << table.text(0, "reason");
  EXPECT_EQ(table.text(1, "status"), "out of memory");
  EXPECT_THAT(table.text(1, "reason"), ::testing::HasSubstr("not enough memory"));
  EXPECT_EQ(table.text(2, "status"), "out of memory");
  EXPECT_THAT(table.text(2, "reason"), ::testing::HasSubstr("the factor does not fit"));
}

TEST(StudyRun, WhatDoesNotVaryIsComputedOnce) {
  const tiny::Folder folder;
  const Ran ran =
      run(R"(<study id="s"> <vary variable="E" values="1000 2000 3000 4000"/> <measure probe="tip"/></study>)", folder);
  // The mesh and two sets of indices are there once; four simulations.
  EXPECT_EQ(ran.sharing.computed, 3U + 4U);
  EXPECT_EQ(ran.sharing.shared, 3U * 3U);
  EXPECT_NEAR(ran.table.number(3, "tip") * 4, ran.table.number(0, "tip"), 1e-9);
}

TEST(StudyRun, ARunWithoutAResultIsARowWithItsReason) {
  const tiny::Folder folder;
  const Ran ran = run(R"(<study id="s"> <vary variable="E" values="1000 -1 1000"/> <vary variable="n" values="1"/>
    <measure probe="tip"/></study>)",
                      folder);
  EXPECT_EQ(ran.table.text(0, "status"), "done");
  EXPECT_EQ(ran.table.text(1, "status"), "refused");
  EXPECT_EQ(ran.table.text(1, "tip"), "");
  EXPECT_NE(ran.table.text(1, "reason").find("youngModulus = -1 is not > 0"), std::string::npos)
      << ran.table.text(1, "reason");
  EXPECT_EQ(ran.table.text(2, "status"), "done");
}

TEST(StudyRun, AStoppedStudyGoesOnFromItsTable) {
  const tiny::Folder folder;
  const std::string study = R"(<study id="s"> <vary variable="E" values="1000 2000"/> <measure probe="tip"/></study>)";
  Table half = run(study, folder).table;
  half.rows.pop_back();
  half.rows[0][3] = "12.5";  // shows that this row is taken as it is
  const Ran ran = run(study, folder, half);
  EXPECT_EQ(ran.table.text(0, "tip"), "12.5");
  EXPECT_EQ(ran.sharing.computed, 4U);
  const std::string other =
      R"(<study id="s"> <vary variable="E" values="1000 2000"/> <measure iterations="newton" id="tip"/></study>)";
  EXPECT_EQ(run(other, folder, half).table.number(0, "tip"), 1) << "another measure is no old row";
}

TEST(StudyRun, TimesAreMediansBetweenTheirLowestAndHighest) {
  const tiny::Folder folder;
  const Ran ran = run(R"(<study id="s" repeat="3"> <vary variable="E" values="1000 2000"/> <measure time="total"/>
    <measure id="mesh_time" time="mesh"/></study>)",
                      folder);
  EXPECT_LE(ran.table.number(0, "time_total_low"), ran.table.number(0, "time_total"));
  EXPECT_GE(ran.table.number(0, "time_total_high"), ran.table.number(0, "time_total"));
  EXPECT_GT(ran.table.number(0, "time_total"), ran.table.number(0, "mesh_time"));
  EXPECT_EQ(ran.table.number(1, "mesh_time"), ran.table.number(0, "mesh_time")) << "the mesh was timed once, thrice";
  EXPECT_EQ(ran.sharing.computed, 3U * (3U + 2U));
  EXPECT_EQ(ran.table.number(0, "passes"), 3);
}

TEST(StudyRun, TimesAreTakenFiveTimesUnlessTheyHaveTakenEnough) {
  const tiny::Folder folder;
  const std::string vary = R"( <vary variable="E" values="1000"/> <measure time="total"/></study>)";
  EXPECT_EQ(run(R"(<study id="s">)" + vary, folder).table.number(0, "passes"), 5);
  EXPECT_EQ(run(R"(<study id="s" enough="1e-9">)" + vary, folder).table.number(0, "passes"), 1);
}

TEST(StudyRun, FieldsOfErrorsAreCheckedBeforeAnythingRuns) {
  const auto faults_of = [](const std::string& field) {
    std::vector<Fault> faults;
    const Document document =
        parse_document(bar("<study id=\"s\"><vary variable=\"E\" values=\"1\"/><reference set=\"n=2\"/><measure "
                           "error=\"L2\" field=\"" +
                           field + "\"/></study>"),
                       "s.xml", faults);
    return tiny::lines(compile(document, real_language()).faults);
  };
  EXPECT_EQ(faults_of("displacement"), "");
  EXPECT_EQ(faults_of("stress_nodal"), "");
  EXPECT_THAT(faults_of("displacment"),
              testing::HasSubstr("there is no field displacment (did you mean 'displacement'?)"));
  EXPECT_THAT(faults_of("stress"), testing::HasSubstr("take stress_nodal"));
}

TEST(StudyRun, SharedNodesCostARunNoTimeOfItsOwn) {
  const tiny::Folder folder;
  const Ran ran =
      run(R"(<study id="s" repeat="1"> <vary variable="E" values="1000 2000"/> <measure id="all" time="total"/>
    <measure id="own" time="own"/> <measure id="simulation" time="simulation"/></study>)",
          folder);
  EXPECT_EQ(ran.table.number(0, "own"), ran.table.number(0, "all")) << "the first computes all";
  EXPECT_GE(ran.table.number(1, "own"), ran.table.number(1, "simulation"))
      << "which does not hold the writing of files";
  EXPECT_GT(ran.table.number(1, "all"), ran.table.number(1, "own"));
}

TEST(StudyRun, ARunApartComputesEveryNodeItself) {
  const tiny::Folder folder;
  const Ran ran = run(R"(<study id="s" repeat="3"> <vary variable="E" values="1000 2000"/> <measure id="on" time="run"/>
    <measure id="off" time="apart"/> <measure id="mesh_time" time="mesh"/> <measure id="all" time="total"/></study>)",
                      folder);
  EXPECT_EQ(ran.sharing.computed, 3U * (3U + 2U)) << "runs apart leave nothing for others";
  EXPECT_EQ(ran.sharing.apart, 3U * 2U * 4U) << "and take nothing from them: all four nodes, each time";
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_EQ(ran.table.text(row, "status"), "done") << ran.table.text(row, "reason");
    EXPECT_GT(ran.table.number(row, "off_low"), 0);
    EXPECT_NE(ran.table.number(row, "off"), ran.table.number(row, "all")) << "a clock, no sum of nodes";
  }
}

int processors() {
  cpu_set_t some;
  return ::sched_getaffinity(0, sizeof some, &some) == 0 ? CPU_COUNT(&some) : 0;
}

TEST(StudyRun, RunsThatAreTimedKeepToTheirProcessors) {
  const tiny::Folder folder;
  const int before = processors();
  int during = 0;
  const RowSink look = [&](const Table&, std::size_t) { during = processors(); };
  run(R"(<study id="s"> <vary variable="E" values="1000"/> <measure time="total"/></study>)", folder, {}, look);
  EXPECT_EQ(during, 1) << "one thread";
  EXPECT_EQ(processors(), before);
  run(R"(<study id="s"> <vary variable="E" values="1000"/> <measure probe="tip"/></study>)", folder, {}, look);
  EXPECT_EQ(during, before) << "nothing is timed";
}

TEST(StudyRun, RunsThatAreNotTimedGoSideBySideWithTheSameResults) {
  const std::string all =
      R"(<vary variable="E" values="1000 2000 3000 4000 5000 6000"/> <vary variable="n" values="1 2"/>
    <measure probe="tip"/>)";
  const auto threads = [&](const std::string& measures, std::string& csv) {
    const tiny::Folder folder;
    std::set<std::thread::id> seen;
    const Ran ran = run(R"(<study id="s">)" + all + measures + "</study>", folder, {},
                        [&](const Table&, std::size_t) {
                          seen.insert(std::this_thread::get_id());
                          std::this_thread::sleep_for(std::chrono::milliseconds(20));  // so that one cannot do them all
                        },
                        3);
    csv = to_csv(ran.table);
    EXPECT_EQ(ran.sharing.computed, 2 * 3U + 12U) << "shared between threads too";
    return seen.size();
  };
  std::string together, again;
  EXPECT_GT(threads("", together), 1U);
  threads("", again);
  EXPECT_EQ(together, again);
  const tiny::Folder folder;
  EXPECT_EQ(to_csv(run(R"(<study id="s">)" + all + "</study>", folder).table), together);
}

TEST(StudyRun, RunsThatAreTimedGoOneByOne) {
  const tiny::Folder folder;
  std::set<std::thread::id> seen;
  run(R"(<study id="s" repeat="1"> <vary variable="E" values="1000 2000 3000"/> <measure time="total"/></study>)",
      folder, {}, [&](const Table&, std::size_t) { seen.insert(std::this_thread::get_id()); }, 3);
  EXPECT_EQ(seen, std::set{std::this_thread::get_id()});
}

TEST(StudyRun, AReferenceThatFailsIsTriedOnce) {
  const tiny::Folder folder;
  // Without a base nothing holds the body.
  const std::string rest = R"( <reference set="low=1e-7"/> <measure error="RMS"/></study>)";
  const Ran one = run(R"(<study id="s"> <vary variable="E" values="1000"/>)" + rest, folder);
  const Ran three = run(R"(<study id="s"> <vary variable="E" values="1000 1000 1000"/>)" + rest, folder);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(three.table.text(row, "status"), "no reference");
    EXPECT_EQ(three.table.text(row, "reason"), one.table.text(0, "reason"));
  }
  EXPECT_EQ(three.sharing.computed, one.sharing.computed);
}

TEST(StudyRun, AReferenceHasALimitToo) {
  const std::string vary = R"( <vary variable="n" values="1 1"/> <measure error="RMS"/> )";
  for (const int jobs : {1, 2}) {
    const tiny::Folder folder;
    const Ran ran =
        run(R"(<study id="s">)" + vary + R"(<reference set="n=12" limit="1e-6"/></study>)", folder, {}, {}, jobs);
    for (std::size_t row = 0; row < 2; ++row) {
      EXPECT_EQ(ran.table.text(row, "status"), "no reference");
      EXPECT_THAT(ran.table.text(row, "reason"), ::testing::HasSubstr("ended after its limit of 1e-06 s"));
    }
  }
  const tiny::Folder folder;
  const Ran own = run(R"(<study id="s" limit="1e-6">)" + vary + R"(<reference set="n=1" limit="60"/></study>)", folder);
  EXPECT_EQ(own.table.text(0, "status"), "limit") << "the reference has its own";
  const Ran same = run(R"(<study id="s" limit="1e-6">)" + vary + R"(<reference set="n=1"/></study>)", folder);
  EXPECT_EQ(same.table.text(0, "status"), "no reference");
}

TEST(StudyRun, ARunBeyondItsLimitIsEndedAndSaysSo) {
  const tiny::Folder folder;
  const Ran ran = run(
      R"(<study id="s" limit="0.3"> <vary variable="parts" values="100000"/> <measure probe="tip"/></study>)", folder);
  EXPECT_EQ(ran.table.text(0, "status"), "limit");
  EXPECT_NE(ran.table.text(0, "reason").find("ended after its limit of 0.3 s"), std::string::npos);
  EXPECT_EQ(ran.table.number(0, "unknowns"), 3 * (8 - 4)) << "a chart marks it at its size";
}

}  // namespace
}  // namespace msml
