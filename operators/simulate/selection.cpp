// SPDX-License-Identifier: GPL-3.0-or-later
// Index sets turned into nodes and elements of a body.
#include "operators/simulate/selection.hpp"

#include <algorithm>
#include <set>

#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

const char* one(Indexed kind) {
  return kind == Indexed::nodes ? "node" : kind == Indexed::elements ? "element" : "face";
}

std::vector<bool> marked(const IndexSet& set, int count) {
  std::vector<bool> in(static_cast<std::size_t>(count), false);
  for (const int id : set.ids) in[static_cast<std::size_t>(id)] = true;
  return in;
}

bool all_solid(const IndexSet& set, const Body& body) {
  return std::all_of(set.ids.begin(), set.ids.end(),
                     [&](int id) { return body.mesh->kinds[static_cast<std::size_t>(id)] == body.kind; });
}

NodeSelection nodes_of_cells(const Record& record, const IndexSet& set, const Body& body) {
  std::set<int> nodes;
  if (set.kind == Indexed::elements && all_solid(set, body)) {
    for (const int id : set.ids) nodes.insert(body.mesh->cell(id), body.mesh->cell(id) + node_count(body.kind));
  } else {
    for (const fe::Face& face : select_faces(record, body).faces)
      for (const int node : face_nodes(*body.mesh, face)) nodes.insert(node);
  }
  return {.nodes = {nodes.begin(), nodes.end()}, .positions = {}, .listed = static_cast<int>(set.ids.size())};
}

NodeSelection listed_nodes(const Record& record, const IndexSet& set, const Body& body) {
  NodeSelection selection;
  selection.listed = static_cast<int>(set.ids.size());
  std::vector<bool> seen(body.solid.size(), false);
  for (int i = 0; i < selection.listed; ++i) {
    const auto id = static_cast<std::size_t>(set.ids[static_cast<std::size_t>(i)]);
    if (seen[id]) refuse(record, fmt::format("indices lists node {} twice", id));
    seen[id] = true;
    if (!body.solid[id]) continue;
    selection.nodes.push_back(static_cast<int>(id));
    selection.positions.push_back(i);
  }
  return selection;
}

}  // namespace

void check_indices(const Record& record, const IndexSet& set, const Mesh& mesh) {
  // Nodes are those of a mesh with the same points, such as particles at those of a mesh of elements.
  const bool same =
      !set.mesh || same_mesh(*set.mesh, mesh) ||
      (set.kind == Indexed::nodes && set.mesh->points.rows() == mesh.points.rows() && set.mesh->points == mesh.points);
  if (!same)
    refuse(record, fmt::format("indices counts {} of another mesh ({}) than the object's ({}); take them from the mesh "
                               "that the object uses",
                               name(set.kind), set.mesh->summary(), mesh.summary()));
  const int count = set.kind == Indexed::nodes ? mesh.point_count() : mesh.cell_count();
  for (const int id : set.ids)
    if (id < 0 || id >= count)
      refuse(record, fmt::format("indices names {} {}, but the mesh has {} 0 to {}", one(set.kind), id,
                                 set.kind == Indexed::nodes ? "nodes" : "cells", count - 1));
}

NodeSelection select_nodes(const Record& record, const Body& body, Reporter& reporter) {
  const IndexSet& set = indices_of(record);
  check_indices(record, set, *body.mesh);
  const bool listed = set.kind == Indexed::nodes;
  const NodeSelection selection = set.ids.empty()
                                      ? NodeSelection{}
                                      : (listed ? listed_nodes(record, set, body) : nodes_of_cells(record, set, body));
  if (selection.nodes.empty() && selection.listed > 0)
    refuse(record, fmt::format("none of the {} in indices belongs to an element of the body, which spans {}",
                               counted(selection.listed, one(set.kind)), bounds(body)));
  if (selection.nodes.empty()) refuse(record, fmt::format("indices is empty; the body spans {}", bounds(body)));
  const int left_out = listed ? selection.listed - static_cast<int>(selection.nodes.size()) : 0;
  if (left_out > 0)
    reporter.note(fmt::format("{}: {} of the {} in indices belong to no element and carry no unknowns", record.tag(),
                              with_commas(left_out), counted(selection.listed, "node")));
  return selection;
}

std::vector<int> select_elements(const Record& record, const Body& body) {
  const IndexSet& set = indices_of(record);
  check_indices(record, set, *body.mesh);
  if (set.kind == Indexed::faces)
    refuse(record, "indices counts faces; a region needs elements, or nodes whose elements are meant");
  std::vector<int> elements;
  if (set.kind == Indexed::elements) {
    const auto in = marked(set, body.mesh->cell_count());
    std::copy_if(body.elements.begin(), body.elements.end(), std::back_inserter(elements),
                 [&](int id) { return in[static_cast<std::size_t>(id)]; });
  } else {
    const auto in = marked(set, body.mesh->point_count());
    std::copy_if(body.elements.begin(), body.elements.end(), std::back_inserter(elements), [&](int id) {
      const int* nodes = body.mesh->cell(id);
      return std::all_of(nodes, nodes + corner_count(body.kind),
                         [&](int node) { return in[static_cast<std::size_t>(node)]; });
    });
  }
  return elements;
}

}  // namespace msml::simulation
