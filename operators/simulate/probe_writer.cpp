// SPDX-License-Identifier: GPL-3.0-or-later
// A field at a place, along a line or at nodes over time.
#include <fmt/format.h>

#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/selection.hpp"
#include "operators/simulate/spots.hpp"

namespace msml::simulation {
namespace {

/// The element that holds a place of the reference configuration. Throws Error outside the body.
Spot find_spot(const Record& record, const Body& body, const SpotFinder& finder, const Vec3& x) {
  Spot spot = finder.find(x);
  if (spot.outside > 1e-8)
    refuse(record, fmt::format("point {} is {:.3g} outside the body, which spans {}", place(x), distance_to(body, x),
                               bounds(body)));
  return spot;
}

/// Where a probe looks.
struct Places {
  std::vector<int> nodes;         ///< a column for each
  std::vector<Spot> spots;        ///< or places in elements: one, or a line of them
  std::vector<double> distances;  ///< of a line: from its start
};

Places places_of(const Simulation& simulation, const OutputRequest& request, Reporter& reporter) {
  const Record& record = *request.record;
  const Body& body = simulation.body;
  Places places;
  if (!request.point) {
    places.nodes = select_nodes(record, body, reporter).nodes;
    return places;
  }
  const SpotFinder finder(body);
  const Vec3 way = request.count > 1 ? Vec3((request.end - *request.point) / (request.count - 1)) : Vec3(Vec3::Zero());
  for (int i = 0; i < request.count; ++i) {
    places.spots.push_back(find_spot(record, body, finder, *request.point + i * way));
    if (request.count > 1) places.distances.push_back(i * way.norm());
  }
  return places;
}

std::vector<std::string> columns(const Places& places, const FieldFacts& facts) {
  std::vector<std::string> names{"time"};
  if (!places.distances.empty()) names.emplace_back("distance");
  const auto group = [&](const std::string& tail) {
    for (const std::string& component : component_names(facts))
      names.push_back(fmt::format("{}{}{}{}", facts.name, component.empty() ? "" : "_", component, tail));
  };
  if (!places.spots.empty()) group("");
  for (const int node : places.nodes) group(places.nodes.size() > 1 ? fmt::format("@{}", node) : "");
  return names;
}

class ProbeWriter final : public TableWriter {
 public:
  ProbeWriter(const Simulation& simulation, const OutputRequest& request, const FieldFacts& facts, Places places,
              const std::filesystem::path& folder)
      : TableWriter(request, folder, columns(places, facts)),
        mesh_(*simulation.body.mesh),
        facts_(facts),
        places_(std::move(places)) {}

 private:
  std::vector<std::vector<double>> rows(const fe::State& state, StateFields& fields) const override {
    const Field field = fields.field(facts_.name);
    std::vector<double> row{state.time};
    for (const int node : places_.nodes) append(field, static_cast<std::size_t>(node), row);
    if (places_.spots.empty()) return {row};
    std::vector<std::vector<double>> all;
    for (std::size_t i = 0; i < places_.spots.size(); ++i) {
      row.resize(1);
      if (!places_.distances.empty()) row.push_back(places_.distances[i]);
      const Spot& spot = places_.spots[i];
      if (fields.is_multiplier(facts_.name))
        row.push_back(fields.multiplier(spot.element, spot.weights));
      else
        append(field, spot, row);
      all.push_back(row);
    }
    return all;
  }

  static void append(const Field& field, std::size_t at, std::vector<double>& out) {
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t c = 0; c < width; ++c) out.push_back(field.values[at * width + c]);
  }

  /// Interpolated between nodes; of a field at elements, the value of the element.
  void append(const Field& field, const Spot& spot, std::vector<double>& out) const {
    if (!facts_.nodal) return append(field, static_cast<std::size_t>(spot.element), out);
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t c = 0; c < width; ++c) {
      double sum = 0;
      for (std::size_t a = 0; a < spot.weights.size(); ++a)
        sum += spot.weights[a] * field.values[static_cast<std::size_t>(mesh_.cell(spot.element)[a]) * width + c];
      out.push_back(sum);
    }
  }

  const Mesh& mesh_;
  FieldFacts facts_;
  Places places_;
};

}  // namespace

std::unique_ptr<OutputWriter> make_probe(const Simulation& simulation, const OutputRequest& request, Reporter& reporter,
                                         const std::filesystem::path& folder) {
  const bool mixed = simulation.model.formulation == fe::Formulation::mixed;
  const FieldFacts facts = facts_of(request.fields.front(), mixed);
  return std::make_unique<ProbeWriter>(simulation, request, facts, places_of(simulation, request, reporter), folder);
}

}  // namespace msml::simulation
