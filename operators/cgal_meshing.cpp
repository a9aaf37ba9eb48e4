// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes and defaults that both volume meshers share.
#include "operators/cgal_meshing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace msml::operators {
namespace {

Key<double> length(Operator& op, const std::string& name, const std::string& doc) {
  return op.parameter<double>(name, {.unit = "length", .range = positive(), .optional = true, .doc = doc});
}

Key<bool> pass(Operator& op, const std::string& name, const std::string& doc) {
  return op.parameter<bool>(name, {.fallback = false, .doc = doc});
}

}  // namespace

MeshingKeys describe_meshing(Operator& op) {
  MeshingKeys keys;
  keys.facet_angle = op.parameter<double>(
      "facetAngle", {.unit = "degree",
                     .range = closed(0, 30),
                     .fallback = 25.0,
                     .doc = "smallest angle of a surface triangle; refinement is known to end up to 30; 0 = no bound"});
  keys.facet_size = length(op, "facetSize",
                           "largest radius of the ball on the surface around a surface triangle; default 1/30 of the "
                           "bounding box's diagonal");
  keys.facet_distance = length(
      op, "facetDistance",
      "largest distance from a triangle's circumcentre to the ball's centre on the surface; default 1/10 of facetSize");
  keys.radius_edge = op.parameter<double>(
      "cellRadiusEdgeRatio",
      {.range = {.low = 1, .low_open = true},
       .fallback = 2.0,
       .doc = "largest circumradius over shortest edge of a tetrahedron; refinement is known to end from 2 upwards"});
  keys.cell_size =
      length(op, "cellSize", "largest circumradius of a tetrahedron; default 1/30 of the bounding box's diagonal");
  keys.odt = pass(op, "odt", "optimal Delaunay smoothing after refinement");
  keys.lloyd = pass(op, "lloyd", "Lloyd smoothing after refinement");
  keys.perturb = pass(op, "pertube", "perturb vertices to remove slivers (spelled as in MSML)");
  keys.exude = pass(op, "exude", "exude slivers by weights on vertices, the last pass");
  op.note(
      "facetSize, facetDistance and cellSize are required in MSML; here they have defaults. "
      "MSML reads lloyd and drops it when it meshes voxels; here every pass asked for is carried out, in the order "
      "odt, lloyd, pertube, exude.");
  return keys;
}

MeshingSettings meshing_settings(Context& context, const MeshingKeys& keys, double diagonal) {
  const auto or_else = [&](Key<double> key, double fallback) { return context.has(key) ? context.get(key) : fallback; };
  MeshingSettings settings;
  settings.facet_angle = context.get(keys.facet_angle);
  settings.facet_size = or_else(keys.facet_size, diagonal / 30);
  settings.facet_distance = or_else(keys.facet_distance, settings.facet_size / 10);
  settings.radius_edge = context.get(keys.radius_edge);
  settings.cell_size = or_else(keys.cell_size, diagonal / 30);
  settings.odt = context.get(keys.odt);
  settings.lloyd = context.get(keys.lloyd);
  settings.perturb = context.get(keys.perturb);
  settings.exude = context.get(keys.exude);
  if (settings.radius_edge < 2)
    context.reporter().warn(fmt::format(
        "cellRadiusEdgeRatio = {} is below 2: refinement is not known to end; MeasureMeshQuality shows what is reached",
        settings.radius_edge));
  return settings;
}

Watcher progress_in_points(Reporter& reporter, double volume, const MeshingSettings& settings) {
  // A tetrahedron of circumradius r that refinement leaves has about 0.15 r^3, and there are about 5.5 of them a point.
  const double expected = std::max(100.0, volume / (0.15 * std::pow(settings.cell_size, 3)) / 5.5);
  const double limit = settings.radius_edge < 2 ? std::max(1e5, 50 * expected) : 1e300;
  return [&reporter, expected, limit, ratio = settings.radius_edge](std::size_t points) {
    if (static_cast<double>(points) > limit)
      throw Error(fmt::format(
          "refinement was stopped at {} points: cellRadiusEdgeRatio = {} is not reached; from 2 upwards it always ends",
          with_commas(static_cast<long long>(points)), ratio));
    reporter.progress(std::min(0.95, static_cast<double>(points) / expected),
                      with_commas(static_cast<long long>(points)) + " points");
  };
}

Announcer announce_passes(Reporter& reporter) {
  return [&reporter](const std::string& pass, bool cut_short) {
    if (!cut_short) return reporter.progress(0, pass);
    reporter.warn(fmt::format(
        "{} had not ended after {:g} s and was stopped: the mesh is valid, but may change with the machine's "
        "speed. Leave that pass out, or choose larger cells",
        pass, pass_patience));
  };
}

}  // namespace msml::operators
