// SPDX-License-Identifier: GPL-3.0-or-later
// Probes, energies and the fields of a result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/output_writer.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

TEST(Probe, InterpolatesAtAPointOfTheReference) {
  const Language language;
  const Record probe = language.tag("probe", "output", {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}});
  const std::string csv = written(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,displacement_x,displacement_y,displacement_z");
  const auto found = csv_rows(csv);
  ASSERT_EQ(found.size(), 3u);  // the start and both load steps
  for (const double share : {0.0, 0.5, 1.0}) {
    const Numbers& row = found[static_cast<std::size_t>(2 * share)];
    EXPECT_NEAR(row[1], -0.003 * 0.3 * share, 1e-9);
    EXPECT_NEAR(row[2], -0.003 * 0.6 * share, 1e-9);
    EXPECT_NEAR(row[3], 0.01 * 0.7 * share, 1e-9);
  }
}

TEST(Probe, AlongALineHasALineOfTheFileForEachPlace) {
  const Language language;
  const Record probe =
      language.tag("probe", "output",
                   {{"id", std::string("p")}, {"along", Numbers{0.5, 0.5, 0, 0.5, 0.5, 1}}, {"count", Integer{5}}});
  const std::string csv = written(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,distance,displacement_x,displacement_y,displacement_z");
  const auto found = csv_rows(csv);
  ASSERT_EQ(found.size(), 15u);  // three states
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(found[10 + i][1], 0.25 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(found[10 + i][4], 0.01 * found[10 + i][1], 1e-9);
  }
}

TEST(Probe, OfAnElementFieldTakesTheElementAtThePoint) {
  const Language language;
  const Record probe = language.tag(
      "probe", "output",
      {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}, {"field", std::string("principalStress")}});
  const std::string csv = written(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,principalStress_1,principalStress_2,principalStress_3");
  const Numbers last = csv_rows(csv).back();
  EXPECT_NEAR(last[1], 10, 1e-6);
  EXPECT_NEAR(last[2], 0, 1e-6);
}

TEST(Probe, AtNodesHasAColumnForEach) {
  const Language language;
  const Record probe = language.tag("probe", "output",
                                    {{"id", std::string("p")},
                                     {"indices", index_set(nullptr, Indexed::nodes, {0, 26})},
                                     {"field", std::string("vonMises_nodal")}});
  const std::string csv = written(language, pulled(language, probe), "p.csv");
  EXPECT_EQ(first_line(csv), "time,vonMises_nodal@0,vonMises_nodal@26");
  EXPECT_NEAR(csv_rows(csv).back()[2], 10, 1e-6);
}

std::string refusal(const Attributes& attributes) {
  const Language language;
  try {
    written(language, pulled(language, language.tag("probe", "output", attributes)), "p.csv");
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
  EXPECT_EQ(refusal({{"id", std::string("p")}}), "scene.xml:7: probe: needs one of point, along and indices");
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
  const std::string csv = written(language, pulled(language, energies), "e.csv");
  EXPECT_EQ(first_line(csv),
            "time,elastic,kinetic,external_work,dissipated,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
            "angular_momentum_y,angular_momentum_z,load_factor");
  const Numbers last = csv_rows(csv).back();
  EXPECT_NEAR(last[1], 0.05, 1e-9);
  EXPECT_NEAR(last[3], 0.05, 1e-9);
}

// Two load steps; the first state has no loads, along an arc or not.
TEST(EnergiesOutput, BeginWithoutLoadsInStatics) {
  const Language language;
  Scene scene = pulled(language, language.tag("energies", "output", {{"id", std::string("e")}}));
  const auto rows = csv_rows(written(language, scene, "e.csv"));
  ASSERT_EQ(rows.size(), 3u);
  for (const std::size_t i : {0, 1, 2}) EXPECT_EQ(rows[i].back(), 0.5 * static_cast<double>(i));
  scene.solver["arcLength"] = true;
  EXPECT_EQ(csv_rows(written(language, scene, "e.csv")).front().back(), 0);
}

TEST(Fields, OfAHomogeneousStateAreKnown) {
  const Language language;
  const auto at_centre = [&](const std::string& field) {
    const Record probe = language.tag("probe", "output",
                                      {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}, {"field", field}});
    Numbers row = csv_rows(written(language, pulled(language, probe), "p.csv")).back();
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
  near(at_centre("secondPiola"), {0, 0, 10, 0, 0, 0});          // and S
  near(at_centre("energyDensity_nodal"), {0.05});
  near(at_centre("J"), {x * x * z});
}

// A run that blew up goes back to its last good state: what came after that is no result.
TEST(Outputs, StatesThatARunGoesBackFromAreTakenAway) {
  const Language language;
  Listener listener;
  const Folder folder;
  Scene scene = cube(language);
  const Record record = scene.record(language);
  simulation::Simulation simulation = simulation::build_model(record, listener, 1);
  simulation.outputs = {{.id = "s", .fields = {"displacement"}},
                        {.id = "e", .kind = simulation::OutputKind::energies},
                        {.id = "v", .kind = simulation::OutputKind::volume}};
  for (const double back : {1.0, 1.5}) {
    const auto writers = simulation::make_writers(simulation, folder.path(), listener);
    const auto state_at = [&](double time) {
      fe::State state{.time = time, .increment = static_cast<int>(time)};
      state.displacement = Points::Zero(simulation.model.mesh->point_count(), 3);
      return state;
    };
    for (const auto& writer : writers) {
      for (const double time : {0, 1, 2, 3}) {
        const fe::State state = state_at(time);
        simulation::StateFields fields(simulation.model, simulation.body, state);
        writer->write(state, fields);
      }
      const fe::State last = state_at(back);
      simulation::StateFields fields(simulation.model, simulation.body, last);
      writer->finish(last, fields);
    }
    for (const char* table : {"e.csv", "v.csv"}) {
      std::vector<double> times;
      for (const Numbers& row : csv_rows(folder.text(table))) times.push_back(row[0]);
      EXPECT_EQ(times, back == 1 ? std::vector<double>({0, 1}) : std::vector<double>({0, 1, 1.5})) << table;
    }
    EXPECT_THAT(folder.text("s.pvd"), testing::Not(testing::HasSubstr("timestep=\"2\"")));
    EXPECT_EQ(std::filesystem::exists(folder.path() / "s_0002.vtu"), back > 1);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "s_0003.vtu"));
  }
}

}  // namespace
}  // namespace msml::test
