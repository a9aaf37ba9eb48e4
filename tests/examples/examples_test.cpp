// SPDX-License-Identifier: GPL-3.0-or-later
// Every example runs, with a coarse setting where it would be slow, and gives the number that its header promises.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "operators/registry.hpp"
#include "tests/pipeline/program.hpp"

namespace msml::testing {
namespace {

using Json = nlohmann::json;

fs::path example(const std::string& name) {
  return fs::path(MSML_SOURCE_DIR) / "examples" / name / (name + ".msml.xml");
}

bool data_are_there() { return fs::exists(sample_data() / "images" / "liver.inr.gz"); }

/// Runs an example into the folder and returns the report of the run.
Json run_example(const std::string& name, const Folder& folder, const std::string& arguments = "") {
  const Finished run = run_msml("exec " + quoted(example(name)) + " -o " + quoted(folder.path()) + " --log-json " +
                                quoted(folder / "log.json") + " " + arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  return Json::parse(content(folder / "log.json"), nullptr, false);
}

Json node(const Json& log, const std::string& id) {
  for (const Json& each : log["nodes"])
    if (each["id"] == id) return each;
  ADD_FAILURE() << "no node " << id;
  return {};
}

double number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  EXPECT_NE(at, std::string::npos) << words << " in " << text;
  return at == std::string::npos ? 0 : std::stod(text.substr(at + words.size()));
}

/// Displacement of the node whose reference position is nearest to X.
Vec3 displacement_at(const fs::path& file, const Vec3& X) {
  Registry registry;
  add_operators(registry);
  const auto mesh = std::get<std::shared_ptr<const Mesh>>(registry.read(file, Type::mesh));
  const auto field = std::find_if(mesh->point_fields.begin(), mesh->point_fields.end(),
                                  [](const Field& f) { return f.name == "displacement"; });
  Vec3 best = Vec3::Zero();
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < mesh->point_count(); ++i) {
    const Vec3 u = Eigen::Map<const Vec3>(field->values.data() + 3 * i);
    const double distance = (mesh->points.row(i).transpose() - u - X).norm();
    if (distance < nearest) nearest = distance, best = u;
  }
  EXPECT_LT(nearest, 1e-9);
  return best;
}

TEST(Examples, TheTipOfTheBeamSinksAsInCalculixAndDolfinx) {
  const Folder folder;
  run_example("beam", folder);
  // Both programs give six digits: half a unit of the last one.
  EXPECT_NEAR(displacement_at(folder / "bent_0001.vtu", {0.1, 0.01, 0.01}).z(), -0.0375280, 5e-8);
}

TEST(Examples, TheLiverHasTheMassOfItsVoxels) {
  if (!data_are_there()) GTEST_SKIP() << "no sample data; ./dev test fetches them";
  const Folder folder;
  const Json log = run_example("liver", folder, "--set size=20 --set steps=2");
  const Json check = node(log, "liver")["check"];
  const double voxels = 3160496 + 314086 + 17702 + 2;
  const double mass = voxels * 0.617188 * 0.617188 * 1.33333 * 1.06e-9;
  EXPECT_NEAR(check["mass"].get<double>(), mass, 0.04 * mass);  // a mesh of 20 mm cuts corners of a body of 200 mm
  EXPECT_LT(check["mass"].get<double>(), mass);
  // Loads are mass times gravity, and equilibrium holds at each step.
  EXPECT_NEAR(check["sumOfLoads"][1].get<double>(), 9810 * check["mass"].get<double>(), 1e-9);
  EXPECT_LT(check["balance"].get<double>(), 1e-6);  // of the loads; Newton stops at 1e-8 of the largest force
  for (const char* region : {"parenchyma", "neighbour", "inclusion"})
    EXPECT_GT(number_after(node(log, region)["result"], ""), 0) << region;
  EXPECT_TRUE(fs::exists(folder / "sag_0001.vtu"));
}

TEST(Examples, TheFemurHasTheVolumeOfItsSurfaceAndIsInEquilibrium) {
  if (!data_are_there()) GTEST_SKIP() << "no sample data; ./dev test fetches them";
  const Folder folder;
  const Json check = node(run_example("femur", folder, "--set size=0.06"), "femur")["check"];
  const double mass = 0.02027398661109929 * 29.6875;            // the divergence theorem on femur.off, computed apart
  EXPECT_NEAR(check["mass"].get<double>(), mass, 0.02 * mass);  // corners cut, concave and convex ones
  EXPECT_NEAR(check["sumOfReactions"][2].get<double>(), -check["sumOfLoads"][2].get<double>(), 1e-6);
  EXPECT_GT(check["sumOfLoads"][2].get<double>(), 500);
}

TEST(Examples, TheReducedLiverHas1800PointsAndItsMeshKeepsTheBound) {
  if (!data_are_there()) GTEST_SKIP() << "no sample data; ./dev test fetches them";
  const Folder folder;
  const Json log = run_example("quality", folder, "--set accuracy=6 --set smoothing=1");
  EXPECT_NE(node(log, "reduced")["result"].get<std::string>().find("1,800 points"), std::string::npos);
  const std::string csv = content(folder / "quality.csv");
  std::istringstream row(csv.substr(csv.find("radiusEdgeRatio,")));
  std::vector<double> numbers;
  for (std::string cell; std::getline(row, cell, ',') && numbers.size() < 9;)
    if (cell != "radiusEdgeRatio") numbers.push_back(std::stod(cell));
  ASSERT_EQ(numbers.size(), 9U);                            // min, seven percentiles, max
  EXPECT_LE(numbers.back(), 2.0 + 1e-9);                    // what was asked for
  EXPECT_GE(numbers.front(), std::sqrt(3.0 / 8.0) - 1e-9);  // of the regular tetrahedron, the least there is
  EXPECT_LT(numbers[4], 1.4);                               // the median is below what the tutorial asks for
}

TEST(Examples, TheTourGivesHalfTheError) {
  const Folder folder;
  const Json log = run_example("tour", folder, "--request error --set voxel=1 --set 'voxels=40 40 40'");
  EXPECT_NEAR(number_after(node(log, "error")["result"], ""), 0.5, 1e-12);  // |2 - 1.5| / |2 - 1| at every moved node
  const double pi = std::numbers::pi;
  const auto volume = [&](const std::string& file) {
    const std::string csv = content(folder / file);
    std::istringstream row(csv.substr(csv.find("volume,")));
    std::vector<std::string> cells;
    for (std::string cell; cells.size() < 11 && std::getline(row, cell, ',');) cells.push_back(cell);
    return std::stod(cells.back());
  };
  EXPECT_NEAR(volume("tube.csv") * 3072, pi * 0.75 * 2, 2e-4 * pi);        // mean volume times elements; curved tet10
  EXPECT_NEAR(volume("ball.csv") * 12288, 4 * pi / 3, 0.02 * 4 * pi / 3);  // chords of 11 degrees
}

TEST(Readme, TheSceneInItRuns) {
  const std::string readme = content(fs::path(MSML_SOURCE_DIR) / "README.md"), fence = "```xml\n";
  const std::size_t from = readme.find(fence) + fence.size(), to = readme.find("```", from);
  ASSERT_LT(to, readme.size());
  const Folder folder;
  const fs::path scene = folder.write("beam.msml.xml", readme.substr(from, to - from));
  const Finished run = run_msml("exec " + quoted(scene) + " -o " + quoted(folder / "out"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(fs::exists(folder / "out" / "bent_0001.vtu"));
}

TEST(Examples, EveryAvailableOperatorStandsInOne) {
  std::string scenes;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(MSML_SOURCE_DIR) / "examples"))
    if (entry.path().string().ends_with(".msml.xml")) scenes += content(entry.path());
  Registry registry;
  add_operators(registry);
  int seen = 0;
  for (const auto& op : registry.operators()) {
    // Simulate is what an <object> is lowered to: it is not written in scenes.
    if (!op->unavailable().empty() || op->tag() == "Simulate") continue;
    ++seen;
    EXPECT_NE(scenes.find("<" + op->tag() + " "), std::string::npos) << op->tag() << " stands in no example";
  }
  EXPECT_GT(seen, 20);
}

}  // namespace
}  // namespace msml::testing
