// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of the operator that fills a surface, beside CGAL called bare with the same criteria.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "tests/operators/shared/run_operator.hpp"

namespace {

using namespace msml;
using Clock = std::chrono::steady_clock;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;
using Domain = CGAL::Polyhedral_mesh_domain_3<Polyhedron, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A time, and the tetrahedra made in it.
struct Measured {
  double seconds = 0;
  std::size_t cells = 0;
  double per_cell() const { return seconds / static_cast<double>(cells); }
};

Measured bare(const Surface& surface, double size) {
  const Clock::time_point start = Clock::now();
  Polyhedron polyhedron;
  std::vector<Polyhedron::Vertex_index> ids;
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
    ids.push_back(polyhedron.add_vertex({surface.points(i, 0), surface.points(i, 1), surface.points(i, 2)}));
  for (const auto& [a, b, c] : surface.triangles)
    polyhedron.add_face(ids[static_cast<std::size_t>(a)], ids[static_cast<std::size_t>(b)],
                        ids[static_cast<std::size_t>(c)]);
  CGAL::get_default_random() = CGAL::Random(0);
  namespace p = CGAL::parameters;
  const Domain domain(polyhedron);
  const CGAL::Mesh_criteria_3<Triangulation> criteria(p::facet_angle = 25, p::facet_size = size,
                                                      p::facet_distance = size / 10, p::cell_radius_edge_ratio = 2,
                                                      p::cell_size = size);
  const auto complex = CGAL::make_mesh_3<Complex>(domain, criteria, p::no_perturb(), p::no_exude());
  return {since(start), complex.number_of_cells_in_complex()};
}

Measured ours(const Value& surface, double size) {
  const Clock::time_point start = Clock::now();
  const Value mesh = test::run("CGALMeshVolumeFromSurface", {{"surfaceMesh", surface},
                                                             {"facetAngle", 25.0},
                                                             {"facetSize", size},
                                                             {"facetDistance", size / 10},
                                                             {"cellRadiusEdgeRatio", 2.0},
                                                             {"cellSize", size}});
  return {since(start), static_cast<std::size_t>(std::get<MeshPtr>(mesh)->cell_count())};
}

void run(double size) {
  const Value ball =
      test::run("GenerateSphereMesh", {{"radius", 1.0}, {"around", Integer{16}}, {"across", Integer{1}}});
  const Value surface = test::run("ExtractSurfaceMesh", {{"mesh", ball}});
  const Surface& triangles = *std::get<SurfacePtr>(surface);
  std::vector<double> ratios;
  std::vector<Measured> runs;
  for (int turn = 0; turn < 3; ++turn) {
    const Measured alone = bare(triangles, size);
    runs.push_back(ours(surface, size));
    ratios.push_back(alone.per_cell() / runs.back().per_cell());
  }
  std::sort(ratios.begin(), ratios.end());
  std::sort(runs.begin(), runs.end(), [](const Measured& a, const Measured& b) { return a.seconds < b.seconds; });
  fmt::print("{{\"answer\": {}, \"total\": {}, \"rate\": {}, \"elements\": {}, \"triangles\": {}}}\n", runs[1].seconds,
             runs[1].seconds, ratios[1], runs[1].cells, triangles.triangles.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fmt::print(stderr, "usage: mesh_bench CELL_SIZE, of a ball of radius 1\n"), 2;
  try {
    run(std::stod(argv[1]));
  } catch (const std::exception& error) {
    return fmt::print(stderr, "mesh_bench: {}\n", error.what()), 2;
  }
}
