// SPDX-License-Identifier: GPL-3.0-or-later
// CGALSimplificateSurface: fewer triangles by edge collapse.
#include <fmt/format.h>

#include "msml/core/operator.hpp"
#include "operators/cgal_surface.hpp"
#include "operators/early_checks.hpp"
#include "operators/mesh_soup.hpp"

namespace msml::operators {
namespace {

std::optional<std::pair<Vec3, Vec3>> kept(const std::vector<double>& box) {
  if (box.size() == 1 && box[0] == -1) return std::nullopt;
  const Bounds bounds = bounds_of(box);
  return std::pair(bounds.low, bounds.high);
}

long edge_count(const Surface& surface, long border) { return (3L * surface.triangle_count() + border) / 2; }

/// The smallest closed surface is a tetrahedron; a target below it, or above what is there, is a mistake.
void check_target(const CollapseTarget& target, const Surface& surface, long edges) {
  if (target.edges && *target.edges > edges)
    throw Error(fmt::format("stopnr = {} edges is more than the surface has: {}", *target.edges, with_commas(edges)));
  if (target.vertices && *target.vertices > surface.point_count())
    throw Error(fmt::format("vertices = {} is more than the surface has: {}", *target.vertices,
                            with_commas(surface.point_count())));
}

void check_result(const Surface& before, const SoupFaults& was, const Surface& after) {
  const SoupFaults now = faults(after);
  if ((was.border_edges == 0 && now.border_edges > 0) || !now.manifold())
    throw Error(fmt::format("the simplified surface is worse than the given one: {}; keep more edges", now.str()));
  if (was.border_edges == 0 && self_intersections(before).empty() && !self_intersections(after).empty())
    throw Error(fmt::format("the simplified surface of {} intersects itself; keep more edges", after.summary()));
}

Surface simplify(const Surface& given, const CollapseTarget& target, const std::vector<double>& box,
                 Reporter& reporter) {
  SoupRepairs repairs;
  const Surface surface = repair(given, repairs);
  note_repairs(reporter, repairs);
  const SoupFaults was = faults(surface);
  if (surface.triangles.empty()) throw Error("the surface has no triangles");
  if (!was.manifold()) throw Error("edges of this surface cannot be collapsed: " + was.str());
  check_target(target, surface, edge_count(surface, was.border_edges));
  Surface result = collapse_edges(surface, target, kept(box));
  check_result(surface, was, result);
  const long edges = edge_count(result, faults(result).border_edges);
  const bool reached = target.edges ? edges <= *target.edges : result.point_count() <= *target.vertices;
  if (!reached)
    reporter.warn(fmt::format("no further edge can be collapsed: {} edges and {} points are left", with_commas(edges),
                              with_commas(result.point_count())));
  return result;
}

}  // namespace

Operator simplify_surface() {
  Operator op("CGALSimplificateSurface", "Make a triangle surface coarser by edge collapse.");
  op.source("CGAL 5.5 Surface Mesh Simplification; Lindstrom and Turk 1998, doi 10.1109/VISUAL.1998.745314");
  const auto surface = op.input<Surface>("inputMeshFile", "a manifold, closed or with border");
  const auto stopnr = op.parameter<Integer>(
      "stopnr", {.range = closed(6, 2147483647.0), .optional = true, .doc = "collapse until fewer edges are left"});
  const auto vertices =
      op.parameter<Integer>("vertices", {.range = closed(4, 2147483647.0),
                                         .optional = true,
                                         .doc = "collapse until so many points are left; instead of stopnr"});
  const auto box = op.parameter<std::vector<double>>(
      "box", {.unit = "length",
              .fallback = std::vector<double>{-1},
              .counts = {1, 6},
              .doc = "xmin ymin zmin xmax ymax zmax: edges with both ends inside are kept; -1 = none"});
  const auto result = op.output<Surface>(
      "outputMeshFile", "closed and free of self-intersections where the input is; fields are dropped");
  op.target("outputMeshFile", result, "file to write the surface to");
  op.note("vertices is an addition to MSML, where stopnr alone tells when to stop.");
  const auto check = [=](const Record& r) {
    if (r.is_given(stopnr) == r.is_given(vertices)) throw Error("give either stopnr (edges) or vertices, and not both");
    if (r.has(box)) kept(r[box]);
  };
  run_checked(op, check, [=](Context& c) {
    CollapseTarget target;
    if (c.has(stopnr))
      target.edges = static_cast<long>(c.get(stopnr));
    else
      target.vertices = static_cast<long>(c.get(vertices));
    c.set(result, simplify(c.get(surface), target, c.get(box), c.reporter()));
  });
  return op;
}

}  // namespace msml::operators
