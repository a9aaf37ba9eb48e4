// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeIndicesFromMaterialId: cells or points that belong to one region of a mesh.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "msml/core/operator.hpp"

namespace msml::operators {
namespace {

std::vector<int> cells_of(const Mesh& mesh, int wanted, int region) {
  std::vector<int> ids;
  for (int c = 0; c < mesh.cell_count(); ++c)
    if (dimension(mesh.kinds[static_cast<std::size_t>(c)]) == wanted && mesh.region(c) == region) ids.push_back(c);
  return ids;
}

std::vector<int> points_of(const Mesh& mesh, int region) {
  std::vector<int> ids;
  for (int c = 0; c < mesh.cell_count(); ++c)
    if (mesh.region(c) == region)
      ids.insert(ids.end(), mesh.cell(c), mesh.cell(c) + node_count(mesh.kinds[static_cast<std::size_t>(c)]));
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

IndexSet select(const Mesh& mesh, const std::string& type, int region) {
  if (type == "elements") return {Indexed::elements, cells_of(mesh, 3, region), nullptr};
  if (type == "faces") return {Indexed::faces, cells_of(mesh, 2, region), nullptr};
  return {Indexed::nodes, points_of(mesh, region), nullptr};
}

void warn_if_empty(const Mesh& mesh, const std::string& type, int region, Reporter& reporter) {
  std::set<int> known;
  for (int c = 0; c < mesh.cell_count(); ++c) known.insert(mesh.region(c));
  reporter.warn(fmt::format("no {} have region {}; the mesh has {} with regions {}", type, region, mesh.summary(),
                            fmt::join(known, ", ")));
}

}  // namespace

Operator indices_from_material() {
  Operator op("ComputeIndicesFromMaterialId", "Ids of the cells or points of one region.");
  op.source("MSML 2015");
  const auto mesh = op.input<Mesh>("mesh", "with regions");
  const auto num = op.parameter<Integer>("num", {.range = closed(-2147483648.0, 2147483647.0), .doc = "the region"});
  const auto type = op.parameter<std::string>(
      "type", {.choices = {"faces", "elements", "points", "points_experimental"},
               .doc = "faces: triangles; elements: tetrahedra; points: nodes of any cell of the region"});
  const auto indices = op.output<IndexSet>("indices", "0-based, ascending; ids run over all cells of the mesh");
  op.note(
      "MSML reads the active cell array; here it is the region of the cell. points_experimental is MSML's word for "
      "points.");
  op.run([=](Context& c) {
    const int region = static_cast<int>(c.get(num));
    IndexSet set = select(c.get(mesh), c.get(type), region);
    if (set.ids.empty()) warn_if_empty(c.get(mesh), c.get(type), region, c.reporter());
    set.mesh = c.share(mesh);
    c.set(indices, std::move(set));
  });
  return op;
}

}  // namespace msml::operators
