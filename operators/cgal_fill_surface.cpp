// SPDX-License-Identifier: GPL-3.0-or-later
// Delaunay refinement inside a closed surface with CGAL Mesh_3.
#include "operators/cgal_fill_surface.hpp"

#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Surface_mesh.h>

#include "operators/cgal_refine.hpp"

namespace msml::operators {
namespace {

using Polyhedron = CGAL::Surface_mesh<refine::Kernel::Point_3>;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<refine::Kernel, Polyhedron>;
using Tr = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using C3t3 = CGAL::Mesh_complex_3_in_triangulation_3<Tr, Domain::Corner_index, Domain::Curve_index>;

Polyhedron polyhedron_of(const Surface& surface) {
  Polyhedron polyhedron;
  std::vector<Polyhedron::Vertex_index> vertices;
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
    vertices.push_back(polyhedron.add_vertex({surface.points(i, 0), surface.points(i, 1), surface.points(i, 2)}));
  const auto vertex = [&](int id) { return vertices[static_cast<std::size_t>(id)]; };
  for (const auto& [a, b, c] : surface.triangles)
    if (polyhedron.add_face(vertex(a), vertex(b), vertex(c)) == Polyhedron::null_face())
      throw Error("the surface is not a manifold", {}, Failure::internal);
  return polyhedron;
}

Mesh refined(const Surface& surface, const std::vector<Seed>& seeds, std::optional<double> feature_angle,
             const MeshingSettings& settings, const Watcher& watcher, const Announcer& announce) {
  CGAL::get_default_random() = CGAL::Random(0);
  CGAL::Random random(0);
  refine::WatchedDomain<Domain> domain(polyhedron_of(surface), &random);
  // At 180 degrees no edge is sharp; the patches of the surface still get their numbers.
  domain.detect_features(feature_angle.value_or(180));
  const auto criteria = refine::criteria<Tr>(settings, watcher);
  C3t3 c3t3;
  if (feature_angle) {
    announce("sharp edges", false);
    CGAL::Mesh_3::internal::init_c3t3_with_features(c3t3, domain, criteria, false);
  }
  refine::insert_seeds(c3t3, domain, seeds);
  if (c3t3.triangulation().dimension() < 3) return {};
  refine::refine_and_improve(c3t3, domain, criteria, settings, announce);
  return refine::mesh_of(c3t3);
}

}  // namespace

Mesh fill_surface(const Surface& surface, const std::vector<Seed>& seeds, std::optional<double> feature_angle,
                  const MeshingSettings& settings, const Watcher& watcher, const Announcer& announce) {
  return refine::guarded([&] { return refined(surface, seeds, feature_angle, settings, watcher, announce); });
}

}  // namespace msml::operators
