// SPDX-License-Identifier: GPL-3.0-or-later
// Probes, energies and the fields of a result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/operators/simulate_scene.hpp"

namespace msml::operators {
Operator simulate();
}

namespace msml::test {
namespace {

using testing::ElementsAre;
using Numbers = std::vector<double>;

/// The unit cube between rollers, its top pulled with a stress of 10 along z (E = 1000, nu = 0.3, small strain):
/// homogeneous, with the strain 0.01 along z and -0.003 across.
Scene pulled(const Language& language, const Record& output) {
  Scene scene = cube(language);
  std::vector<int> all(static_cast<std::size_t>(scene.mesh->cell_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  scene.regions = {region(language, "a", index_set(scene.mesh, Indexed::elements, all), 1000, 0.3, "small")};
  for (int k = 0; k < 3; ++k) {
    Numbers normal{0, 0, 0};
    normal[static_cast<std::size_t>(k)] = 1;
    scene.constraints.push_back(
        condition(language, "symmetryPlane", {{"indices", points_at(scene.mesh, k, 0)}, {"normal", normal}}));
  }
  scene.constraints.push_back(condition(language, "surfaceTraction",
                                        {{"indices", points_at(scene.mesh, 2, 1)}, {"traction", Numbers{0, 0, 10}}}));
  scene.solver["loadSteps"] = Integer{2};
  scene.outputs = {output};
  return scene;
}

/// What the scene writes into a file.
std::string file(const Language& language, const Scene& scene, const std::string& name) {
  const Folder folder;
  Listener listener;
  const Record record = scene.record(language);
  Context context(record, listener, folder.path(), 1);
  operators::simulate()(context);
  return folder.text(name);
}

std::vector<Numbers> rows(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<Numbers> all;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    all.emplace_back();
    for (double x; words >> x;) all.back().push_back(x);
  }
  return all;
}

std::string first_line(const std::string& csv) { return csv.substr(0, csv.find('\n')); }

TEST(Probe, InterpolatesAtAPointOfTheReference) {
  const Language language;
  const Record probe = language.tag("probe", "output", {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}});
  const std::string csv = file(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,displacement_x,displacement_y,displacement_z");
  const auto found = rows(csv);
  ASSERT_EQ(found.size(), 3u);  // the start and both load steps
  for (const double share : {0.0, 0.5, 1.0}) {
    const Numbers& row = found[static_cast<std::size_t>(2 * share)];
    EXPECT_NEAR(row[1], -0.003 * 0.3 * share, 1e-9);
    EXPECT_NEAR(row[2], -0.003 * 0.6 * share, 1e-9);
    EXPECT_NEAR(row[3], 0.01 * 0.7 * share, 1e-9);
  }
}

TEST(Probe, OfAnElementFieldTakesTheElementAtThePoint) {
  const Language language;
  const Record probe = language.tag(
      "probe", "output",
      {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}, {"field", std::string("principalStress")}});
  const std::string csv = file(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,principalStress_1,principalStress_2,principalStress_3");
  const Numbers last = rows(csv).back();
  EXPECT_NEAR(last[1], 10, 1e-6);
  EXPECT_NEAR(last[2], 0, 1e-6);
}

TEST(Probe, AtNodesHasAColumnForEach) {
  const Language language;
  const Record probe = language.tag("probe", "output",
                                    {{"id", std::string("p")},
                                     {"indices", index_set(nullptr, Indexed::nodes, {0, 26})},
                                     {"field", std::string("vonMises_nodal")}});
  const std::string csv = file(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,vonMises_nodal@0,vonMises_nodal@26");
  EXPECT_NEAR(rows(csv).back()[2], 10, 1e-6);
}

std::string refusal(const Attributes& attributes) {
  const Language language;
  try {
    file(language, pulled(language, language.tag("probe", "output", attributes)), "p.csv");
  } catch (const Error& error) {
    return error.str();
  }
  return "";
}

TEST(Probe, OutsideTheBodyNamesTheDistance) {
  EXPECT_EQ(refusal({{"id", std::string("p")}, {"point", Numbers{0.5, 0.5, 1.25}}}),
            "scene.xml:7: probe: point (0.5, 0.5, 1.25) is 0.25 outside the body, which spans (0, 0, 0) to (1, 1, 1)");
}

TEST(Probe, NeedsAPlaceAndAFieldThatIsThere) {
  EXPECT_EQ(refusal({{"id", std::string("p")}}), "scene.xml:7: probe: needs either point or indices");
  EXPECT_EQ(
      refusal({{"id", std::string("p")},
               {"indices", index_set(nullptr, Indexed::nodes, {0})},
               {"field", std::string("stress")}}),
      "scene.xml:7: probe: field stress is given at elements; a probe at nodes takes stress_nodal, one at a point "
      "both");
}

// Linear: the work is half the load times the way, 10 * 0.01 / 2, and all of it is elastic.
TEST(EnergiesOutput, HoldTheWorkOfTheLoad) {
  const Language language;
  const Record energies = language.tag("energies", "output", {{"id", std::string("e")}});
  const std::string csv = file(language, pulled(language, energies), "e.csv");
  EXPECT_EQ(first_line(csv),
            "time,elastic,kinetic,external_work,dissipated,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
            "angular_momentum_y,angular_momentum_z,load_factor");
  const Numbers last = rows(csv).back();
  EXPECT_NEAR(last[1], 0.05, 1e-9);
  EXPECT_NEAR(last[3], 0.05, 1e-9);
}

TEST(Fields, OfAHomogeneousStateAreKnown) {
  const Language language;
  const auto at_centre = [&](const std::string& field) {
    const Record probe = language.tag("probe", "output",
                                      {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}, {"field", field}});
    Numbers row = rows(file(language, pulled(language, probe), "p.csv")).back();
    row.erase(row.begin());
    return row;
  };
  const auto near = [](const Numbers& found, const Numbers& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-7) << i;
  };
  const double x = 0.997, z = 1.01;
  near(at_centre("stress"), {0, 0, 10, 0, 0, 0});
  near(at_centre("pressure_nodal"), {-10.0 / 3});
  near(at_centre("deformationGradient"), {x, 0, 0, 0, x, 0, 0, 0, z});
  near(at_centre("greenLagrange"), {(x * x - 1) / 2, (x * x - 1) / 2, (z * z - 1) / 2, 0, 0, 0});
  near(at_centre("firstPiola"), {0, 0, 0, 0, 0, 0, 0, 0, 10});  // small strain: its stress is P
  near(at_centre("secondPiola"), {0, 0, 10 / z, 0, 0, 0});
  near(at_centre("energyDensity_nodal"), {0.05});
  near(at_centre("J"), {x * x * z});
}

}  // namespace
}  // namespace msml::test
