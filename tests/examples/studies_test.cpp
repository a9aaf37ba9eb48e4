// SPDX-License-Identifier: GPL-3.0-or-later
// The studies that are shipped: all are free of faults, and some run here with small settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/pipeline/program.hpp"
#include "tests/sanitized.hpp"

namespace msml::testing {
namespace {

using Json = nlohmann::json;

fs::path scene(const std::string& name) {
  return fs::path(MSML_SOURCE_DIR) / "examples" / "studies" / (name + ".msml.xml");
}

/// Runs a study and returns its results.json.
Json run_study(const std::string& name, const std::string& study, const Folder& folder,
               const std::string& arguments = "") {
  const Finished run =
      run_msml("study " + quoted(scene(name)) + " " + study + " -o " + quoted(folder.path()) + " " + arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  return Json::parse(content(folder / study / "results.json"), nullptr, false);
}

/// log2 of the ratio of a measure between two meshes of an element, the second with edges of half the length.
double order(const Json& results, const std::string& element, const std::string& measure, double nu = 0.3) {
  std::vector<double> errors;
  for (const Json& row : results["rows"])
    if (row["element"] == element && row["nu"] == nu) errors.push_back(row[measure]);
  EXPECT_EQ(errors.size(), 2U) << element;
  return std::log2(errors[0] / errors[1]);
}

TEST(Studies, AllOfThemAreFreeOfFaults) {
  const fs::path examples = scene("beam").parent_path().parent_path();
  for (const char* folder : {"studies", "stability"}) {
    int seen = 0;
    for (const auto& entry : fs::directory_iterator(examples / folder)) {
      if (!entry.path().string().ends_with(".msml.xml")) continue;
      ++seen;
      const Finished check = run_msml("check " + quoted(entry.path()));
      EXPECT_EQ(check.code, 0) << check.err;
      EXPECT_NE(content(entry.path()).find("<study "), std::string::npos) << entry.path();
    }
    EXPECT_GE(seen, 2) << folder;
  }
}

// A map of the stability atlas: accurate up to the limits of theory, stopped with a reason beyond them.
TEST(Studies, TheMapOfCompressionFollowsTheory) {
  const Folder folder;
  const fs::path file = scene("beam").parent_path().parent_path() / "stability" / "compression.msml.xml";
  const Finished run = run_msml("study " + quoted(file) + " -o " + quoted(folder.path()));
  ASSERT_EQ(run.code, 0) << run.err;
  const Json results = Json::parse(content(folder / "compression/results.json"), nullptr, false);
  EXPECT_EQ(results["rows"].size(), 57U);
  for (const Json& row : results["rows"]) {
    const double limit = row["law"] == "corotated"           ? 1000
                         : row["law"] == "StVenantKirchhoff" ? 1000 / (3 * std::sqrt(3.0))
                                                             : std::numeric_limits<double>::infinity();
    const bool holds =
        std::stod(row["pressure"].is_string() ? row["pressure"].get<std::string>() : row["pressure"].dump()) < limit;
    EXPECT_EQ(row["status"], holds ? "done" : "not converged") << row.dump();
    if (!holds) continue;
    EXPECT_LT(row["error"], 1e-6) << row.dump();  // Newton's tolerance near the turn of the curve
  }
}

TEST(Studies, ConvergeAtTheOrdersOfTheory) {
  const Folder folder;
  const Json results = run_study("convergence", "smooth_solution", folder, "--set 'sizes=4 8'");
  // p + 1 in L2 and p in H1; on meshes of 4 and 8 elements along an edge the asymptotic order is met within 0.35.
  for (const char* element : {"tet10", "tet10SR", "mixed"}) {
    EXPECT_NEAR(order(results, element, "L2"), 3, 0.35) << element;
    EXPECT_NEAR(order(results, element, "H1"), 2, 0.35) << element;
  }
  for (const char* element : {"tet4", "tet4Fbar"}) {
    EXPECT_NEAR(order(results, element, "L2"), 2, 0.35) << element;
    EXPECT_NEAR(order(results, element, "H1"), 1, 0.35) << element;
  }
  // Near nu = 1/2 the elements that are made for it keep their order, and tet4 locks.
  EXPECT_NEAR(order(results, "mixed", "L2", 0.4999), 3, 0.35);
  EXPECT_NEAR(order(results, "tet4Fbar", "L2", 0.4999), 2, 0.35);
  EXPECT_LT(order(results, "tet4", "L2", 0.4999), 0.5);
}

// Stopped in the middle and started again, a study goes on from its table and ends with the same one.
TEST(Studies, GoOnWhereTheyWereStopped) {
  const Folder folder;
  const fs::path maps = scene("beam").parent_path().parent_path() / "stability";
  const std::string arguments = "study " + quoted(maps / "compression.msml.xml") + " -j 2 -o ";
  ASSERT_EQ(run_msml(arguments + quoted(folder / "whole")).code, 0);
  const fs::path table = folder / "stopped" / "compression" / "results.csv";
  // Ended by force as soon as the table has some rows.
  const fs::path script = folder.write("stop.sh", "'" MSML_PROGRAM "' " + arguments + quoted(folder / "stopped") +
                                                      " & p=$!\nfor i in $(seq 2000); do test -s " + quoted(table) +
                                                      " && break; sleep 0.005; done\nkill -9 $p; wait $p\n");
  EXPECT_NE(std::system(("bash " + quoted(script) + " 2>/dev/null").c_str()), 0);
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const auto before = lines(content(table));
  ASSERT_GE(before, 2);
  ASSERT_LT(before, 58);
  const Finished again = run_msml(arguments + quoted(folder / "stopped"));
  EXPECT_EQ(again.code, 0) << again.err;
  int carried_out = 0;
  for (std::size_t at = again.err.find("\n["); at != std::string::npos; at = again.err.find("\n[", at + 1))
    ++carried_out;
  EXPECT_EQ(carried_out, 58 - before) << again.err;
  EXPECT_EQ(content(table), content(folder / "whole" / "compression" / "results.csv"));
}

TEST(Studies, LeaveTablesPagesAndCharts) {
  const Folder folder;
  const Json results = run_study("uncertainty", "uncertainty", folder, "--html --set samples=12");
  EXPECT_EQ(results["rows"].size(), 12U);
  for (const Json& row : results["rows"]) EXPECT_EQ(row["status"], "done");
  if (!sanitized) {  // a slow run is not repeated five times
    EXPECT_EQ(results["nodesShared"], 5 * 11 * 5)
        << "the mesh and what goes with it is made once for each of five passes";
    EXPECT_EQ(results["nodesComputedApart"], 5 * 12 * 6) << "with sharing off every sample makes it anew";
  }
  const fs::path out = folder / "uncertainty";
  for (const char* file : {"results.csv", "page.md", "page.html", "distribution.gp"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
  const std::string page = content(out / "page.md");
  EXPECT_NE(page.find("## Spread"), std::string::npos);
  EXPECT_NE(page.find("s with sharing on"), std::string::npos) << page;
  EXPECT_NE(page.find("s with sharing off"), std::string::npos);
  const Finished chart = run_msml("chart " + quoted(out / "results.csv") + " --x E --y sunk --scale linear");
  EXPECT_EQ(chart.code == 0, fs::exists(out / "sunk_over_E.svg")) << chart.err;
  const Finished wrong = run_msml("chart " + quoted(out / "results.csv") + " --x E --y sank");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("has no column sank (did you mean 'sunk'?)"), std::string::npos) << wrong.err;
}

TEST(Studies, AnUnknownNameIsSaid) {
  const Finished run = run_msml("study " + quoted(scene("beam")) + " beam_gravty");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("no study is called beam_gravty (did you mean 'beam_gravity'?)"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace msml::testing
