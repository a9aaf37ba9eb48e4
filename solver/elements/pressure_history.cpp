// SPDX-License-Identifier: GPL-3.0-or-later
// The convolution of pressures at corners.
#include "solver/elements/pressure_history.hpp"

#include <algorithm>

namespace msml::fe {

PressureHistory::PressureHistory(const Model& model, const Numbering& numbering) {
  // An element of each additional node, by which one knows its region.
  std::vector<int> element_of(numbering.pressure_of.size());
  for (std::size_t k = 0; k < numbering.pressure_nodes.size(); ++k)
    element_of[static_cast<std::size_t>(numbering.pressure_nodes[k] - numbering.body_nodes())] =
        static_cast<int>(k / 4);
  std::vector<std::vector<int>> by_region(model.regions.size());
  for (std::size_t n = 0; n < element_of.size(); ++n)
    by_region[static_cast<std::size_t>(numbering.region_of[static_cast<std::size_t>(element_of[n])])].push_back(
        static_cast<int>(n));
  for (std::size_t r = 0; r < by_region.size(); ++r) {
    const Region& region = model.regions[r];
    if (region.prony.g.empty()) continue;
    for (std::size_t first = 0; first < by_region[r].size(); first += lanes) {
      const std::size_t count = std::min<std::size_t>(lanes, by_region[r].size() - first);
      std::vector<int> elements;
      std::vector<Vec3> places;
      int node[lanes] = {};
      for (std::size_t k = 0; k < count; ++k) {
        const int n = by_region[r][first + k];
        const auto e = static_cast<std::size_t>(element_of[static_cast<std::size_t>(n)]);
        elements.push_back(numbering.elements[e]);
        places.push_back(numbering.mesh->points.row(numbering.pressure_of[static_cast<std::size_t>(n)]).transpose());
        node[k] = numbering.body_nodes() + n;
      }
      Nodes& nodes = nodes_.emplace_back(
          Nodes{.count = static_cast<int>(count), .node = {}, .series = series_of(region, elements, {&places, 1})[0]});
      std::copy_n(node, lanes, nodes.node);
      nodes.parts.resize(region.prony.g.size());
    }
  }
}

void PressureHistory::begin_step(double dt) {
  for (Nodes& nodes : nodes_) nodes.series.begin_step(dt);
}

void PressureHistory::end_step(const Vector& u) {
  for (Nodes& nodes : nodes_) {
    Lanes now{};
    for (int k = 0; k < nodes.count; ++k) now[k] = u[3 * nodes.node[k]];
    now *= nodes.series.scale();
    nodes.relaxed = nodes.series.rest() * now;
    for (std::size_t i = 0; i < nodes.parts.size(); ++i) {
      nodes.series.advance(i, now - nodes.elastic, nodes.parts[i]);
      nodes.relaxed += nodes.parts[i];
    }
    nodes.elastic = now;
  }
}

Vector PressureHistory::acting(const Vector& u) const {
  Vector values = u;
  for (const Nodes& nodes : nodes_)
    for (int k = 0; k < nodes.count; ++k) values[3 * nodes.node[k]] = nodes.relaxed[k];
  return values;
}

std::size_t PressureHistory::bytes() const {
  std::size_t sum = nodes_.size() * sizeof(Nodes);
  for (const Nodes& nodes : nodes_) sum += nodes.series.bytes() + nodes.parts.size() * sizeof(Lanes);
  return sum;
}

}  // namespace msml::fe
