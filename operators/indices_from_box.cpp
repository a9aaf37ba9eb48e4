// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeIndicesFromBoxROI: points, elements or surface triangles inside an axis-parallel box.
#include <fmt/format.h>

#include <algorithm>

#include "msml/core/operator.hpp"
#include "operators/early_checks.hpp"

namespace msml::operators {
namespace {

/// Cells of one dimension whose nodes all lie in the box.
std::vector<int> cells_inside(const Mesh& mesh, int wanted, const Bounds& box) {
  std::vector<int> ids;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    bool inside = dimension(kind) == wanted;
    for (int i = 0; inside && i < node_count(kind); ++i)
      inside = box.holds(mesh.points.row(mesh.cell(c)[i]).transpose());
    if (inside) ids.push_back(c);
  }
  return ids;
}

int highest_dimension(const Mesh& mesh) {
  int highest = 0;
  for (const CellKind kind : mesh.kinds) highest = std::max(highest, dimension(kind));
  return highest;
}

bool has_cells(const Mesh& mesh, int wanted) {
  return std::any_of(mesh.kinds.begin(), mesh.kinds.end(), [&](CellKind kind) { return dimension(kind) == wanted; });
}

IndexSet select_inside(const Mesh& mesh, const std::string& select, const Bounds& box) {
  IndexSet set;
  if (select == "points") {
    for (int i = 0; i < mesh.point_count(); ++i)
      if (box.holds(mesh.points.row(i).transpose())) set.ids.push_back(i);
    return set;
  }
  set.kind = select == "elements" ? Indexed::elements : Indexed::faces;
  const int highest = highest_dimension(mesh);
  if (highest < 3 && (set.kind == Indexed::elements || has_cells(mesh, highest - 1))) {
    set.ids = cells_inside(mesh, set.kind == Indexed::elements ? highest : highest - 1, box);
    return set;
  }
  if (select == "surfaceElements" && mesh.count(CellKind::tri3) + mesh.count(CellKind::tri6) == 0)
    throw Error(
        fmt::format("select = surfaceElements needs triangles, but the mesh has {}; make them with ExtractSurfaceMesh, "
                    "or select points",
                    mesh.summary()));
  set.ids = cells_inside(mesh, set.kind == Indexed::elements ? 3 : 2, box);
  return set;
}

void warn_if_empty(const Mesh& mesh, const std::string& select, const IndexSet& set, Reporter& reporter) {
  if (!set.ids.empty() || mesh.point_count() == 0) return;
  const Vec3 low = mesh.points.colwise().minCoeff(), high = mesh.points.colwise().maxCoeff();
  reporter.warn(fmt::format("no {} lie in the box; the mesh reaches from ({:g} {:g} {:g}) to ({:g} {:g} {:g})", select,
                            low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
}

}  // namespace

Operator indices_from_box() {
  Operator op("ComputeIndicesFromBoxROI", "Ids of points, elements or surface triangles inside a box.");
  op.source("MSML 2015");
  const auto mesh = op.input<Mesh>("mesh", "any mesh");
  const auto box = op.parameter<std::vector<double>>(
      "box", {.unit = "length", .counts = {6}, .doc = "xmin ymin zmin xmax ymax zmax, inclusive, along the axes"});
  const auto select = op.parameter<std::string>(
      "select", {.choices = {"points", "elements", "surfaceElements"},
                 .doc = "points; elements: tetrahedra (of a plane mesh triangles, of a line mesh lines) with all nodes "
                        "inside; surfaceElements: triangles (lines of a plane mesh, if it has any; vertices of a line "
                        "mesh) with all nodes inside, by their cell ids in the mesh"});
  const auto indices = op.output<IndexSet>("indices", "0-based, ascending; nodes, elements or faces of the mesh");
  op.note("A box that holds nothing gives an empty set and a warning.");
  const auto check = [=](const Record& r) {
    if (r.has(box)) bounds_of(r[box]);
  };
  run_checked(op, check, [=](Context& c) {
    IndexSet set = select_inside(c.get(mesh), c.get(select), bounds_of(c.get(box)));
    warn_if_empty(c.get(mesh), c.get(select), set, c.reporter());
    set.mesh = c.share(mesh);
    c.set(indices, std::move(set));
  });
  return op;
}

}  // namespace msml::operators
