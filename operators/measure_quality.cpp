// SPDX-License-Identifier: GPL-3.0-or-later
// MeasureMeshQuality: the shape of every tetrahedron, its distribution, and the worst ones with their places.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "msml/core/operator.hpp"
#include "operators/mesh_quality.hpp"
#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

struct Measured {
  std::vector<int> cells;           ///< ids of the tetrahedra
  std::vector<TetQuality> quality;  ///< of each
  std::vector<double> column(const Measure& m) const {
    std::vector<double> values;
    for (const TetQuality& q : quality) values.push_back(q.*m.value);
    return values;
  }
};

Measured measure(const Mesh& mesh, Reporter& reporter) {
  Measured out;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    if (!is_tet(kind)) continue;
    if (c % 65536 == 0) reporter.progress(static_cast<double>(c) / mesh.cell_count(), "measuring");
    out.cells.push_back(c);
    out.quality.push_back(kind == CellKind::tet4 ? quality_of(corners_of(mesh, c)) : quality_of(nodes_of(mesh, c)));
  }
  return out;
}

/// Ends of the histogram: fixed where the measure has a natural range, so that two meshes compare bin by bin.
std::pair<double, double> ends(const Measure& m, const Measured& measured) {
  if (m.name == "minDihedralAngle") return {0, 72};
  if (m.name == "maxDihedralAngle") return {70, 180};
  if (m.name == "scaledJacobian") return {-1, 1};
  if (m.name == "radiusEdgeRatio") return {0.6, 3};
  if (m.name == "edgeRatio" || m.name == "radiusRatio") return {1, 5};
  const auto values = measured.column(m);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high > *low ? *high : *low + 1};
}

std::string place(const Mesh& mesh, int cell) {
  const Vec3 middle = corners_of(mesh, cell).colwise().mean();
  return fmt::format("{:.6g},{:.6g},{:.6g}", middle.x(), middle.y(), middle.z());
}

/// Positions in `measured` of the worst tetrahedra, worst first.
std::vector<std::size_t> worst(const Measured& measured, const Measure& m, std::size_t count) {
  std::vector<std::size_t> order(measured.cells.size());
  std::iota(order.begin(), order.end(), 0);
  count = std::min(count, order.size());
  const auto worse = [&](std::size_t a, std::size_t b) {
    const double x = measured.quality[a].*m.value, y = measured.quality[b].*m.value;
    return x != y ? (m.small_is_bad ? x < y : x > y) : a < b;
  };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), worse);
  order.resize(count);
  return order;
}

std::string table(const Mesh& mesh, const Measured& measured, int bins, std::size_t worst_count) {
  std::string text = "measure,min,p1,p5,p25,p50,p75,p95,p99,max,mean\n";
  std::string histograms = "\nmeasure,from,to,count,share\n", list = "\nmeasure,rank,element,value,x,y,z\n";
  for (const Measure& m : measures()) {
    const auto [low, high] = ends(m, measured);
    const Statistics s = statistics(measured.column(m), low, high, bins);
    text += fmt::format("{},{:.6g}", m.name, s.min);
    for (const double p : s.percentiles) text += fmt::format(",{:.6g}", p);
    text += fmt::format(",{:.6g},{:.6g}\n", s.max, s.mean);
    for (std::size_t b = 0; b < s.histogram.size(); ++b) {
      const double width = (high - low) / bins, from = low + static_cast<double>(b) * width;
      histograms += fmt::format("{},{:.6g},{:.6g},{},{:.6g}\n", m.name, from, from + width, s.histogram[b],
                                static_cast<double>(s.histogram[b]) / static_cast<double>(measured.cells.size()));
    }
    const auto order = worst(measured, m, worst_count);
    for (std::size_t rank = 0; rank < order.size(); ++rank)
      list += fmt::format("{},{},{},{:.6g},{}\n", m.name, rank + 1, measured.cells[order[rank]],
                          measured.quality[order[rank]].*m.value, place(mesh, measured.cells[order[rank]]));
  }
  return text + histograms + list;
}

std::string summary_line(const Mesh& mesh, const Measured& measured) {
  double volume = 0;
  long inverted = 0;
  TetQuality w = measured.quality.front();
  for (const TetQuality& q : measured.quality) {
    volume += q.volume;
    inverted += q.scaled_jacobian <= 0;
    w.edge_ratio = std::max(w.edge_ratio, q.edge_ratio);
    w.min_dihedral = std::min(w.min_dihedral, q.min_dihedral);
    w.max_dihedral = std::max(w.max_dihedral, q.max_dihedral);
    w.radius_edge = std::max(w.radius_edge, q.radius_edge);
    w.scaled_jacobian = std::min(w.scaled_jacobian, q.scaled_jacobian);
  }
  return fmt::format(
      "quality of {}: volume {:.6g}, dihedral angles {:.1f} to {:.1f} degrees, edge ratio up to {:.2f}, "
      "radius-edge ratio up to {:.2f}, scaled Jacobian from {:.3f}, {} inverted",
      mesh.summary(), volume, w.min_dihedral, w.max_dihedral, w.edge_ratio, w.radius_edge, w.scaled_jacobian, inverted);
}

/// The mesh with one cell field per measure; 0 on cells that are no tetrahedra.
Mesh with_fields(const Mesh& mesh, const Measured& measured) {
  Mesh out = mesh;
  for (const Measure& m : measures()) {
    std::erase_if(out.cell_fields, [&](const Field& f) { return f.name == m.name; });
    Field field{m.name, 1, std::vector<double>(mesh.kinds.size(), 0)};
    for (std::size_t i = 0; i < measured.cells.size(); ++i)
      field.values[static_cast<std::size_t>(measured.cells[i])] = measured.quality[i].*m.value;
    out.cell_fields.push_back(std::move(field));
  }
  return out;
}

}  // namespace

Operator measure_quality() {
  Operator op("MeasureMeshQuality",
              "Measure the shape of every tetrahedron and report the distribution and the worst.");
  op.source(
      "volume, edge ratio, dihedral angles, radius ratio, radius-edge ratio, scaled Jacobian, from their definitions; "
      "curved tet10 by "
      "the Bernstein coefficients of the Jacobian");
  const auto mesh = op.input<Mesh>("mesh", "tet4 or tet10");
  const auto bins =
      op.parameter<Integer>("bins", {.range = closed(1, 1000), .fallback = 20, .doc = "of each histogram"});
  const auto count =
      op.parameter<Integer>("worst", {.range = closed(0, 1000000),
                                      .fallback = 10,
                                      .doc = "how many of the worst elements are listed by each measure"});
  const auto measured_mesh = op.output<Mesh>("mesh",
                                             "the mesh with cell fields volume, edgeRatio, minDihedralAngle, "
                                             "maxDihedralAngle, radiusRatio, radiusEdgeRatio, scaledJacobian");
  const auto csv =
      op.output<std::string>("csv", "three tables: percentiles, histograms, worst elements with their centres");
  const auto line = op.output<std::string>("summary", "one line");
  const auto smallest =
      op.output<double>("smallestAngle", "smallest angle between two faces of a tetrahedron, degrees");
  op.target("meshFilename", measured_mesh, "file to write the measured mesh to");
  op.target("csvFilename", csv, "file to write the tables to");
  op.note(
      "MSML has quality measures in its library, without an operator. Angles and ratios of a tet10 are those of its "
      "corners.");
  op.run([=](Context& c) {
    const Mesh& given = c.get(mesh);
    require_tets(given, "MeasureMeshQuality");
    const Measured measured = measure(given, c.reporter());
    const std::string text = summary_line(given, measured);
    c.reporter().print(text);
    c.set(measured_mesh, with_fields(given, measured));
    c.set(csv, table(given, measured, static_cast<int>(c.get(bins)), static_cast<std::size_t>(c.get(count))));
    c.set(line, text);
    c.set(smallest,
          std::min_element(measured.quality.begin(), measured.quality.end(), [](const auto& a, const auto& b) {
            return a.min_dihedral < b.min_dihedral;
          })->min_dihedral);
  });
  return op;
}

}  // namespace msml::operators
