// SPDX-License-Identifier: GPL-3.0-or-later
// CGALMeshVolumeFromSurface: a closed triangle surface becomes a tetrahedral mesh.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "operators/cgal_fill_surface.hpp"
#include "operators/cgal_surface.hpp"
#include "operators/mesh_flat.hpp"
#include "operators/mesh_soup.hpp"

namespace msml::operators {
namespace {

/// A short segment through the middle of a triangle, across the surface.
Seed across(const Surface& surface, int triangle) {
  const auto& [a, b, c] = surface.triangles[static_cast<std::size_t>(triangle)];
  const Vec3 pa = surface.points.row(a), pb = surface.points.row(b), pc = surface.points.row(c);
  const Vec3 middle = (pa + pb + pc) / 3, normal = (pb - pa).cross(pc - pa);
  const double length = std::sqrt(normal.norm());
  const Vec3 step = 1e-3 * length * normal.normalized();
  return {middle + step, middle - step, 1e-3 * length};
}

/// For each connected part of the surface the triangles farthest out in 14 directions, so that no part is missed.
std::vector<Seed> seeds_on(const Surface& surface) {
  const std::vector<int> part = parts_of(surface);
  std::map<int, std::array<std::pair<double, int>, 14>> farthest;
  std::array<Vec3, 14> directions;
  for (int d = 0; d < 3; ++d) directions[static_cast<std::size_t>(d)] = Vec3::Unit(d);
  for (std::size_t d = 0; d < 4; ++d) directions[3 + d] = Vec3(d & 1 ? 1 : -1, d & 2 ? 1 : -1, 1);
  for (std::size_t d = 0; d < 7; ++d) directions[7 + d] = -directions[d];
  for (std::size_t t = 0; t < part.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 sum = surface.points.row(a) + surface.points.row(b) + surface.points.row(c);
    auto [entry, fresh] = farthest.try_emplace(part[t]);
    if (fresh) entry->second.fill({-std::numeric_limits<double>::infinity(), -1});
    for (std::size_t d = 0; d < 14; ++d)
      entry->second[d] = std::max(entry->second[d], {sum.dot(directions[d]), static_cast<int>(t)});
  }
  std::vector<Seed> seeds;
  for (const auto& [id, triangles] : farthest)
    for (const auto& [height, triangle] : triangles) seeds.push_back(across(surface, triangle));
  return seeds;
}

/// Meshers put four points of a plane face into one tetrahedron now and then, above all beside sharp edges.
void tell_of_flat(Mesh& mesh, Reporter& reporter) {
  if (const long dropped = drop_flat(mesh); dropped > 0)
    reporter.note(fmt::format("{} tetrahedra without height were taken off the boundary", with_commas(dropped)));
  if (const long left = count_flat(mesh); left > 0)
    reporter.warn(
        fmt::format("{} tetrahedra have almost no height; pertube and exude improve them", with_commas(left)));
}

Mesh fill(Context& c, const Surface& given, const MeshingKeys& keys, std::optional<double> feature_angle) {
  SoupRepairs repairs;
  const Surface surface = repair(given, repairs);
  note_repairs(c.reporter(), repairs);
  refuse_unless_closed(surface);
  const Vec3 extent = surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff();
  const MeshingSettings settings = meshing_settings(c, keys, extent.norm());
  const Watcher watcher = progress_in_points(c.reporter(), std::abs(enclosed_volume(surface)), settings);
  Mesh mesh = fill_surface(surface, seeds_on(surface), feature_angle, settings, watcher, announce_passes(c.reporter()));
  if (mesh.cell_count() == 0)
    throw Error(fmt::format("no tetrahedra: the body is too thin for facetSize = {}, facetDistance = {}, cellSize = {}",
                            settings.facet_size, settings.facet_distance, settings.cell_size));
  mesh.regions.clear();
  tell_of_flat(mesh, c.reporter());
  return mesh;
}

}  // namespace

Operator mesh_volume_from_surface() {
  Operator op("CGALMeshVolumeFromSurface", "Fill a closed triangle surface with linear tetrahedra.");
  op.source("CGAL 5.5 Mesh_3, 3D Mesh Generation; Polygon Mesh Processing for the checks of the input");
  const auto surface = op.input<Surface>(
      "surfaceMesh", "closed, manifold, free of self-intersections; may have several parts and cavities");
  const auto preserve =
      op.parameter<bool>("preserveFeatures", {.fallback = false, .doc = "keep sharp edges and corners of the surface"});
  const auto angle = op.parameter<double>(
      "featureAngle",
      {.unit = "degree",
       .range = {.low = 0, .high = 180, .low_open = true, .high_open = true},
       .fallback = 60.0,
       .doc = "with preserveFeatures: an edge is sharp where the normals of its two triangles differ by more"});
  const MeshingKeys keys = describe_meshing(op);
  const auto mesh = op.output<Mesh>("mesh", "tet4, positive volumes, region 0");
  op.target("meshFilename", mesh, "file to write the mesh to");
  op.note(
      "preserveFeatures detects sharp edges (MSML passes the option on without detecting any); edges are cut to "
      "facetSize. "
      "Points with equal coordinates are merged and triangles turned to agree; an open, non-manifold or "
      "self-intersecting surface is refused with counts.");
  op.run([=](Context& c) {
    const auto feature_angle = c.get(preserve) ? std::optional(c.get(angle)) : std::nullopt;
    c.set(mesh, fill(c, c.get(surface), keys, feature_angle));
  });
  return op;
}

}  // namespace msml::operators
