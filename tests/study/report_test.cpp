// SPDX-License-Identifier: GPL-3.0-or-later
// results.json: what was run, with what, and what its numbers mean.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "msml/commands/study.hpp"
#include "msml/study/table.hpp"
#include "msml/study/units.hpp"
#include "tests/commands/real_language.hpp"
#include "tests/content.hpp"
#include "tests/study/bar.hpp"

namespace msml {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;
using testing::content;

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

/// Runs the one study `s` of a scene as the command does, and returns its results.json.
Json run(const fs::path& scene, const std::vector<std::string>& set = {}, int threads = 1) {
  StudyArguments arguments{.scene = {.scene = scene.string(), .output_folder = (scene.parent_path() / "out").string()},
                           .name = ""};
  arguments.scene.set = set;
  arguments.scene.threads = threads;
  arguments.scene.quiet = true;
  arguments.versions = library_versions();
  EXPECT_EQ(study_command(real_language(), arguments), 0);
  return Json::parse(content(scene.parent_path() / "out" / "s" / "results.json"), nullptr, false);
}

constexpr const char* two_runs = R"(<study id="s"> <vary variable="n" values="1 2"/> <vary variable="E" values="1000"/>
  <reference set="n=3"/> <measure probe="tip" component="z"/> <measure id="off" error="RMS" relative="false"/>
  <measure id="rest" probe="tip" error="RMS"/> <measure memory="matrix"/></study>)";

TEST(StudyRecord, HoldsWhatIsNeededToRunItAgain) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml";
  write(scene, studies::bar(two_runs));
  const Json first = run(scene, {"kind=tet10"});
  EXPECT_EQ(first["commandLine"]["set"], (Json{{"kind", "tet10"}}));
  EXPECT_EQ(first["commandLine"]["threads"], 1);
  EXPECT_EQ(first["commandLine"]["sharing"], true);
  EXPECT_EQ(first["variablesInForce"]["kind"], "tet10");
  EXPECT_EQ(first["variablesInForce"]["low"], "-9");
  for (const char* library : {"msml", "CGAL", "VTK", "Eigen", "SuiteSparse", "MUMPS", "gnuplot"})
    EXPECT_NE(first["versions"].value(library, ""), "") << library;
  EXPECT_NE(first["machine"].get<std::string>().find("processors"), std::string::npos);
  EXPECT_EQ(first["definition"]["reference"]["set"]["n"], "3");
  const Json same = run(scene, {"kind=tet10"});
  EXPECT_EQ(same["sceneHash"], first["sceneHash"]);
  write(scene, studies::bar(two_runs) + "<!-- changed -->");
  EXPECT_NE(run(scene, {"kind=tet10"})["sceneHash"], first["sceneHash"]);
}

TEST(StudyRecord, EveryColumnHasItsUnit) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml";
  write(scene, studies::bar(two_runs));
  const Json plain = run(scene);
  for (const std::string& column : read_csv(folder.path() / "out" / "s" / "results.csv").columns)
    EXPECT_TRUE(plain["columnUnits"].contains(column)) << column;
  EXPECT_EQ(plain["columnUnits"]["tip_z"], "length");
  EXPECT_EQ(plain["columnUnits"]["off"], "length") << "an error that is not relative";
  EXPECT_EQ(plain["columnUnits"]["rest"], "1");
  EXPECT_EQ(plain["columnUnits"]["E"], "stress");
  EXPECT_EQ(plain["columnUnits"]["status"], "text");
  EXPECT_EQ(plain["columnUnits"]["memory_matrix"], "bytes");
  write(scene, studies::bar(two_runs, "mm N s MPa"));
  const Json labelled = run(scene);
  EXPECT_EQ(labelled["columnUnits"]["tip_z"], "mm");
  EXPECT_EQ(labelled["columnUnits"]["E"], "MPa");
  EXPECT_EQ(labelled["columnLabels"]["E"], "E [MPa]");
}

TEST(StudyRecord, TimesOfOtherThreadsAreTakenAnew) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml";
  write(scene,
        studies::bar(R"(<study id="s" repeat="1"><vary variable="n" values="1"/><measure time="total"/></study>)"));
  EXPECT_GT(run(scene)["nodesComputed"], 0);
  EXPECT_EQ(run(scene)["nodesComputed"], 0) << "the table holds it";
  EXPECT_GT(run(scene, {}, 2)["nodesComputed"], 0);
}

std::string script(const fs::path& folder, const std::string& id) { return content(folder / (id + ".gp")); }

constexpr const char* charted =
    R"(<study id="s"> <vary variable="n" values="1 2"/> <vary variable="E" values="1000 2000"/>
  <reference set="n=3"/> <measure id="error" error="RMS"/>
  <chart id="map" x="n" y="E" color="error" scale="linear" accurate="0.1" theory="1000*X" limits="1.5"/>
  <chart id="curve" x="E" y="error" group="n" title="Errors"/></study>)";

TEST(ChartCommand, DrawsTheChartsOfAStudyAgain) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml", out = folder.path() / "out" / "s";
  write(scene, studies::bar(charted, "mm N s MPa"));
  run(scene);
  const std::string map = script(out, "map"), curve = script(out, "curve");
  EXPECT_NE(map.find("$theory0"), std::string::npos);
  EXPECT_NE(curve.find("E [MPa]"), std::string::npos);
  for (const char* id : {"map.gp", "curve.gp"}) fs::remove(out / id);
  chart_command({.table = (out / "results.csv").string()});
  EXPECT_EQ(script(out, "map"), map) << "with theory, limits and labels";
  EXPECT_EQ(script(out, "curve"), curve);
}

TEST(ChartCommand, ChangesWhatIsAskedAndKeepsTheRest) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml", out = folder.path() / "out" / "s";
  write(scene, studies::bar(charted, "mm N s MPa"));
  run(scene);
  chart_command({.table = (out / "results.csv").string(),
                 .chart = "curve",
                 .output = (out / "other").string(),
                 .theory = {"1/X"}});
  EXPECT_NE(script(out, "other").find("$theory0"), std::string::npos);
  EXPECT_NE(script(out, "other").find("Errors"), std::string::npos) << "its title";
  EXPECT_NE(script(out, "other").find("E [MPa]"), std::string::npos) << "and its units";
  chart_command({.table = (out / "results.csv").string(), .x = "n", .y = "E", .scale = "linear", .color = "error"});
  EXPECT_NE(script(out, "E_over_n").find("set object rectangle"), std::string::npos) << "a map";
}

TEST(ChartCommand, NamesAllFaultsAtOnce) {
  const tiny::Folder folder;
  const fs::path scene = folder.path() / "s.xml", out = folder.path() / "out" / "s";
  write(scene, studies::bar(charted));
  run(scene);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(chart_command({.table = (out / "results.csv").string(),
                           .x = "nn",
                           .y = "errr",
                           .group = {"EE"},
                           .only = {"n"},
                           .theory = {"1/("}}),
            2);
  const std::string told = ::testing::internal::GetCapturedStderr();
  for (const char* each : {"no column nn (did you mean 'n'?)", "no column errr (did you mean 'error'?)", "no column EE",
                           "--only n is not of the form", "--theory 1/("})
    EXPECT_NE(told.find(each), std::string::npos) << told;
}

TEST(Units, EveryFieldOfResultsHasOne) {
  const Description* result = real_language().find("result", {"output"});
  ASSERT_NE(result, nullptr);
  for (const std::string& field : result->slots()[static_cast<std::size_t>(result->find("fields"))].choices)
    EXPECT_NE(field_unit(field), "") << field;
}

TEST(Units, OfAVariableAreThoseOfTheAttributesThatItFillsAlone) {
  const auto unit = [](const std::string& young, const std::string& density) {
    std::string text = studies::bar("");
    const auto put = [&](const std::string& old, const std::string& now) {
      text.replace(text.find(old), old.size(), now);
    };
    put("youngModulus=\"${E}\"", "youngModulus=\"" + young + "\"");
    put("massDensity=\"1\"", "massDensity=\"" + density + "\"");
    const Compilation scene = compile_text(text, "s.xml", real_language());
    EXPECT_EQ(tiny::lines(scene.faults), "");
    return scene.variables.at("E").unit;
  };
  EXPECT_EQ(unit("${E}", "1"), "stress");
  EXPECT_EQ(unit("1", "${E}"), "mass/volume");
  EXPECT_EQ(unit("2*${E}", "1"), "") << "a factor may have any unit";
  EXPECT_EQ(unit("${E}", "2*${E}"), "stress");
  EXPECT_EQ(unit("${E}", "${E}"), "") << "of two units neither is its own";
}

TEST(Units, LabelsTakeThePlaceOfWords) {
  EXPECT_EQ(in_labels("force/length", "mm N s MPa"), "N/mm");
  EXPECT_EQ(in_labels("length/time^2", "m kg s Pa"), "m/s^2");
  EXPECT_EQ(in_labels("mass/volume", "mm N s MPa"), "mass/volume") << "no label says it";
  EXPECT_EQ(in_labels("stress", ""), "stress");
}

}  // namespace
}  // namespace msml
