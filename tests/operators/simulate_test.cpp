// SPDX-License-Identifier: GPL-3.0-or-later
// A cube from record to results on disk, against closed forms.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "operators/formats/formats.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::operators {
Operator simulate();
}

namespace msml::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

/// Rollers on three sides and a traction of 10 along z on top: E = 1000, nu = 0.3.
Scene pulled_cube(const Language& language) {
  Scene scene = cube(language);
  const char* axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    scene.constraints.push_back(condition(
        language, "fixedConstraint", {{"indices", points_at(scene.mesh, k, 0)}, {"components", std::string(axes[k])}}));
  scene.constraints.push_back(
      condition(language, "surfaceTraction",
                {{"indices", points_at(scene.mesh, 2, 1)}, {"traction", std::vector<double>{0, 0, 10}}}));
  scene.outputs = {language.tag("result", "output", {{"id", std::string("pulled")}})};
  return scene;
}

struct Ran {
  Listener listener;
  std::vector<Value> outputs;
  SeriesPtr series(std::size_t i = 0) const { return std::get<SeriesPtr>(outputs.at(i)); }
};

Ran run(const Language& language, const Scene& scene, const Folder& folder) {
  Ran ran;
  const Record record = scene.record(language);
  Context context(record, ran.listener, folder.path(), 1);
  operators::simulate()(context);
  ran.outputs = context.outputs;
  return ran;
}

const Field& field(const std::vector<Field>& fields, const std::string& name) {
  for (const Field& each : fields)
    if (each.name == name) return each;
  throw std::logic_error("no field " + name);
}

TEST(Simulate, UniaxialTractionGivesTheClosedForm) {
  const Language language;
  const Folder folder;
  const Ran ran = run(language, pulled_cube(language), folder);
  const Mesh& last = *ran.series()->last;
  const auto& u = field(last.point_fields, "displacement").values;
  double error = 0;
  for (int i = 0; i < last.point_count(); ++i) {
    const Vec3 moved(u[3 * i], u[3 * i + 1], u[3 * i + 2]), x = last.points.row(i).transpose();
    const Vec3 X = x - moved;
    error = std::max(error, (moved - Vec3(-0.003 * X[0], -0.003 * X[1], 0.01 * X[2])).norm());
  }
  EXPECT_LT(error, 1e-10);  // linear tetrahedra hold a linear field exactly; Newton's tolerance is 1e-8 of the load
}

TEST(Simulate, UniaxialTractionGivesStressEnergyVolumeAndReactions) {
  const Language language;
  const Folder folder;
  const Ran ran = run(language, pulled_cube(language), folder);
  const Mesh& last = *ran.series()->last;
  const auto& stress = field(last.cell_fields, "stress").values;
  for (int c = 0; c < last.cell_count(); ++c) {
    EXPECT_NEAR(stress[6 * c + 2], 10, 1e-6);  // force over reference area; Newton's tolerance
    EXPECT_NEAR(stress[6 * c], 0, 1e-6);
    EXPECT_NEAR(field(last.cell_fields, "vonMises").values[c], 10, 1e-6);
    EXPECT_NEAR(field(last.cell_fields, "energyDensity").values[c], 0.05, 1e-8);  // t^2 / 2E
    EXPECT_NEAR(field(last.cell_fields, "J").values[c], 1.01 * 0.997 * 0.997, 1e-9);
    EXPECT_NEAR(field(last.cell_fields, "strain").values[6 * c + 2], 0.01, 1e-9);
  }
  for (const double value : field(last.point_fields, "vonMises_nodal").values) EXPECT_NEAR(value, 10, 1e-6);
  double sum = 0;
  for (int i = 0; i < last.point_count(); ++i) sum += field(last.point_fields, "reaction").values[3 * i + 2];
  EXPECT_NEAR(sum, -10, 1e-6);  // the traction on an area of 1
}

TEST(Simulate, FilesHoldWhatTheSeriesSays) {
  const Language language;
  const Folder folder;
  const Ran ran = run(language, pulled_cube(language), folder);
  EXPECT_THAT(folder.files(), ElementsAre("pulled.json", "pulled.pvd", "pulled_0000.vtu", "pulled_0001.vtu"));
  const SeriesPtr series = ran.series();
  EXPECT_EQ(series->pattern, "pulled_*.vtu");
  EXPECT_THAT(series->times, ElementsAre(0, 5));  // 100 iterations of 0.05
  const auto mesh = std::get<MeshPtr>(operators::vtk_xml_grid().read(series->files.back(), Type::mesh));
  EXPECT_EQ(mesh->points, series->last->points);
  EXPECT_EQ(field(mesh->cell_fields, "stress").values, field(series->last->cell_fields, "stress").values);
  EXPECT_THAT(folder.text("pulled.pvd"), HasSubstr(R"(timestep="5" part="0" file="pulled_0001.vtu")"));
  EXPECT_THAT(folder.text("pulled.json"), HasSubstr(R"("ended": "converged")"));
}

TEST(Simulate, TheFirstStateIsUndeformed) {
  const Language language;
  const Folder folder;
  const Scene scene = pulled_cube(language);
  const Ran ran = run(language, scene, folder);
  const auto first = std::get<MeshPtr>(operators::vtk_xml_grid().read(ran.series()->files.front(), Type::mesh));
  EXPECT_EQ(first->points, scene.mesh->points);
}

TEST(Simulate, EveryNthStateAndTheLastAreWritten) {
  const Language language;
  const Folder folder;
  Scene scene = pulled_cube(language);
  scene.solver["timeIntegration"] = std::string("dynamicImplicitEuler");
  scene.steps = {language.tag("step", "step", {{"dt", 0.1}, {"iterations", Integer{7}}})};
  scene.outputs = {language.tag("displacement", "output", {{"id", std::string("some")}, {"timestep", Integer{3}}}),
                   language.tag("displacement", "output", {{"id", std::string("all")}})};
  const Ran ran = run(language, scene, folder);
  ASSERT_EQ(ran.series(0)->times.size(), 4U);  // 0, 3, 6 and the last, 7
  EXPECT_NEAR(ran.series(0)->times[2], 0.6, 1e-12);
  EXPECT_NEAR(ran.series(0)->times[3], 0.7, 1e-12);
  EXPECT_EQ(ran.series(1)->files.size(), 8U);
}

TEST(Simulate, LoadStepsOfAStaticStepAreNotWritten) {
  const Language language;
  const Folder folder;
  Scene scene = pulled_cube(language);
  scene.solver["loadSteps"] = Integer{4};
  EXPECT_EQ(run(language, scene, folder).series()->files.size(), 2U);
}

TEST(Simulate, StatesOfALongerRunAreRemovedAndOtherFilesStay) {
  const Language language;
  const Folder folder;
  for (const char* old : {"pulled_0002.vtu", "pulled_0107.vtu", "pulled_more_0003.vtu", "pulled_x.vtu", "pulled_7.vtu"})
    std::ofstream(folder.path() / old) << "old";
  run(language, pulled_cube(language), folder);
  EXPECT_THAT(folder.files(), ElementsAre("pulled.json", "pulled.pvd", "pulled_0000.vtu", "pulled_0001.vtu",
                                          "pulled_7.vtu", "pulled_more_0003.vtu", "pulled_x.vtu"));
}

TEST(Simulate, ProgressCountsTheStepsOfEachStage) {
  const Language language;
  const Folder folder;
  Scene scene = pulled_cube(language);
  scene.solver["timeIntegration"] = std::string("Newmark");
  scene.steps = {
      language.tag("step", "step", {{"name", std::string("first")}, {"dt", 0.5}, {"iterations", Integer{1}}}),
      language.tag("step", "step", {{"name", std::string("second")}, {"dt", 0.25}, {"iterations", Integer{2}}})};
  const Ran ran = run(language, scene, folder);
  std::vector<std::string> words = ran.listener.words;  // said again where a step takes long
  words.erase(std::unique(words.begin(), words.end()), words.end());
  EXPECT_THAT(words, ElementsAre("step 'first' 0/1  t = 0", "step 'first' 1/1  t = 0.5", "step 'second' 1/2  t = 0.75",
                                 "step 'second' 2/2  t = 1"));
}

TEST(Simulate, TheCheckIsPrintedAndRecorded) {
  const Language language;
  const Folder folder;
  const Ran ran = run(language, pulled_cube(language), folder);
  ASSERT_EQ(ran.listener.prints.size(), 1U);
  EXPECT_THAT(ran.listener.prints[0], HasSubstr("check of 'cube'"));
  EXPECT_THAT(ran.listener.prints[0], HasSubstr("  sum of loads            (0, 0, 10)\n"));
  EXPECT_THAT(ran.listener.prints[0], HasSubstr("  mass                    2\n"));
  EXPECT_THAT(ran.listener.facts.at("settings"), HasSubstr(R"("timeIntegration": "static")"));
  EXPECT_THAT(ran.listener.facts.at("check"),
              HasSubstr(R"("unknowns": 54)"));  // 27 points, 9 of them held on each side
}

// Squeezed to less than nothing in one increment: pieces of it are found, and the last of them is on disk.
TEST(Simulate, TheLastGoodStateIsWrittenAlsoBetweenReportedOnes) {
  const Language language;
  const Folder folder;
  Scene scene = pulled_cube(language);
  scene.solver["adaptiveStep"] = true;
  scene.constraints.push_back(
      condition(language, "displacementConstraint",
                {{"indices", points_at(scene.mesh, 2, 1)}, {"displacement", std::vector<double>{0, 0, -1.5}}}));
  scene.outputs.push_back(language.tag("energies", "output", {{"id", std::string("e")}}));
  Ran ran;
  const Record record = scene.record(language);
  Context context(record, ran.listener, folder.path(), 1);
  EXPECT_THROW(operators::simulate()(context), Error);
  EXPECT_THAT(folder.files(), IsSupersetOf({"pulled_0000.vtu", "pulled_0001.vtu"}));
  const std::vector<std::vector<double>> rows = csv_rows(folder.text("e.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_GT(rows[1].back(), 0.5);  // of the loads
  EXPECT_LT(rows[1].back(), 1);
  EXPECT_THAT(folder.text("pulled.pvd"), HasSubstr(fmt::format("timestep=\"{:.17g}\"", rows[1][0])));
}

TEST(Simulate, ARunThatDoesNotConvergeKeepsItsLastGoodState) {
  const Language language;
  const Folder folder;
  Scene scene = pulled_cube(language);
  scene.solver["newtonIterations"] = Integer{2};
  scene.solver["tolerance"] = 1e-15;  // below round-off, so never reached
  scene.constraints.push_back(
      condition(language, "displacementConstraint",
                {{"indices", points_at(scene.mesh, 2, 1)}, {"displacement", std::vector<double>{30, 20, -0.9}}}));
  Ran ran;
  const Record record = scene.record(language);
  Context context(record, ran.listener, folder.path(), 1);
  try {
    operators::simulate()(context);
    FAIL() << "converged";
  } catch (const Error& error) {
    EXPECT_EQ(error.failure(), Failure::not_converged);
    EXPECT_EQ(error.where().line, 7);
    EXPECT_THAT(error.what(), HasSubstr("initial"));
  }
  // The start, and the furthest equilibrium that was found when the reason was looked for.
  EXPECT_THAT(folder.files(), ElementsAre("pulled.json", "pulled.pvd", "pulled_0000.vtu", "pulled_0001.vtu"));
  EXPECT_THAT(folder.text("pulled.pvd"), HasSubstr("pulled_0001.vtu"));
}

}  // namespace
}  // namespace msml::test
