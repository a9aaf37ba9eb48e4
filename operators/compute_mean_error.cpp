// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeMeanError: how far a test deformation is from a reference deformation, relative to the deformation itself.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "msml/core/operator.hpp"

namespace msml::operators {

Operator compute_mean_error();

namespace {

/// Nodes of the faces that belong to one tetrahedron only; without tetrahedra, nodes of the triangles.
std::vector<int> boundary_nodes(const Mesh& mesh) {
  std::map<std::array<int, 3>, std::vector<int>> faces;  // corners -> nodes; emptied when met a second time
  std::vector<int> triangles;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    const int* const ids = mesh.cell(c);
    if (dimension(kind) == 2) triangles.insert(triangles.end(), ids, ids + node_count(kind));
    if (dimension(kind) != 3) continue;
    for (const auto& face : tet_faces) {
      std::vector<int> nodes;
      for (std::size_t k = 0; k < (kind == CellKind::tet10 ? 6U : 3U); ++k) nodes.push_back(ids[face[k]]);
      std::array<int, 3> corners{nodes[0], nodes[1], nodes[2]};
      std::sort(corners.begin(), corners.end());
      const auto [place, fresh] = faces.emplace(corners, std::move(nodes));
      if (!fresh) place->second.clear();
    }
  }
  std::vector<int> found = faces.empty() ? std::move(triangles) : std::vector<int>();
  for (const auto& [corners, nodes] : faces) found.insert(found.end(), nodes.begin(), nodes.end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void require_same_count(const Mesh& initial, const Mesh& other, const char* name) {
  if (initial.point_count() != other.point_count())
    throw Error(fmt::format("{} has {} points, initialMesh {}; the meshes must have the same nodes", name,
                            other.point_count(), initial.point_count()));
}

double mean_error(const Mesh& initial, const Mesh& reference, const Mesh& test, bool surface_only) {
  require_same_count(initial, reference, "referenceMesh");
  require_same_count(initial, test, "testMesh");
  std::vector<int> nodes(static_cast<std::size_t>(initial.point_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  if (surface_only) nodes = boundary_nodes(initial);
  double difference = 0, motion = 0;
  for (const int i : nodes) {
    difference += (reference.points.row(i) - test.points.row(i)).norm();
    motion += (initial.points.row(i) - reference.points.row(i)).norm();
  }
  if (!(motion > 0))
    throw Error(
        fmt::format("no node of the {} compared moves from initialMesh to referenceMesh, so there is nothing to "
                    "relate the error to",
                    nodes.size()));
  return difference / motion;
}

}  // namespace

Operator compute_mean_error() {
  Operator op("ComputeMeanError",
              "Relative mean error of node positions: sum |reference - test| / sum |initial - reference|.");
  op.note(
      "MSML divided this relative error by the number of nodes once more, so that it vanished on fine meshes; here "
      "it is the mean distance between test and reference over the mean displacement of the reference.");
  const auto initial = op.input<Mesh>("initialMesh", "before the deformation");
  const auto reference = op.input<Mesh>("referenceMesh", "deformed, taken as true; same nodes");
  const auto test = op.input<Mesh>("testMesh", "deformed, to be judged; same nodes");
  const auto surface_only = op.parameter<bool>(
      "surfaceOnly", {.fallback = false, .doc = "true: only nodes on the boundary of initialMesh count"});
  const auto error = op.output<double>("error", "0 = equal, 1 = as wrong as no deformation at all");
  op.run([=](Context& c) {
    c.set(error, mean_error(c.get(initial), c.get(reference), c.get(test), c.get(surface_only)));
  });
  return op;
}

}  // namespace msml::operators
