// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle surfaces in CGAL: self-intersections, edge collapse, nearest points.
#include "operators/cgal_surface.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <fmt/format.h>

#include <algorithm>

#include "msml/core/error.hpp"
#include "operators/mesh_soup.hpp"

namespace msml::operators {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;
namespace sms = CGAL::Surface_mesh_simplification;

Kernel::Point_3 point_of(const Surface& surface, int i) {
  return {surface.points(i, 0), surface.points(i, 1), surface.points(i, 2)};
}

Polyhedron polyhedron_of(const Surface& surface) {
  Polyhedron polyhedron;
  for (int i = 0; i < surface.point_count(); ++i) polyhedron.add_vertex(point_of(surface, i));
  using Vertex = Polyhedron::Vertex_index;
  for (const auto& [a, b, c] : surface.triangles)
    if (polyhedron.add_face(Vertex(static_cast<std::uint32_t>(a)), Vertex(static_cast<std::uint32_t>(b)),
                            Vertex(static_cast<std::uint32_t>(c))) == Polyhedron::null_face())
      throw Error("the surface is not a manifold with consistent orientation", {}, Failure::internal);
  return polyhedron;
}

Surface surface_of(const Polyhedron& polyhedron) {
  Surface surface;
  std::vector<int> ids(polyhedron.num_vertices() + polyhedron.number_of_removed_vertices(), -1);
  surface.points.resize(static_cast<Eigen::Index>(polyhedron.number_of_vertices()), 3);
  int next = 0;
  for (const auto v : polyhedron.vertices()) {
    const auto& p = polyhedron.point(v);
    surface.points.row(next) = Eigen::RowVector3d(p.x(), p.y(), p.z());
    ids[v.idx()] = next++;
  }
  for (const auto f : polyhedron.faces()) {
    std::array<int, 3> triangle;
    std::size_t i = 0;
    for (const auto v : CGAL::vertices_around_face(polyhedron.halfedge(f), polyhedron)) triangle[i++] = ids[v.idx()];
    surface.triangles.push_back(triangle);
  }
  return surface;
}

/// Tells the collapse which edges must stay.
struct Kept {
  using key_type = Polyhedron::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;
  const Polyhedron* polyhedron;
  std::optional<std::pair<Vec3, Vec3>> box;
  bool holds(Polyhedron::Vertex_index v) const {
    const auto& p = polyhedron->point(v);
    const Vec3 at(p.x(), p.y(), p.z());
    return (at.array() >= box->first.array()).all() && (at.array() <= box->second.array()).all();
  }
  friend bool get(const Kept& kept, key_type edge) {
    const auto h = kept.polyhedron->halfedge(edge);
    return kept.box && kept.holds(kept.polyhedron->source(h)) && kept.holds(kept.polyhedron->target(h));
  }
};

/// Stops below a number of edges, or when as many vertices are gone as wanted.
struct Enough {
  CollapseTarget target;
  const Polyhedron* polyhedron;
  template <class F, class Profile>
  bool operator()(const F&, const Profile&, std::size_t, std::size_t edges) const {
    if (target.edges) return static_cast<long>(edges) < *target.edges;
    return static_cast<long>(polyhedron->number_of_vertices()) <= *target.vertices;
  }
};

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

}  // namespace

std::vector<std::pair<int, int>> self_intersections(const Surface& surface) {
  const Polyhedron polyhedron = polyhedron_of(surface);
  std::vector<std::pair<Polyhedron::Face_index, Polyhedron::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(polyhedron, std::back_inserter(found));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : found)
    pairs.emplace_back(std::min(static_cast<int>(a.idx()), static_cast<int>(b.idx())),
                       std::max(static_cast<int>(a.idx()), static_cast<int>(b.idx())));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void refuse_unless_closed(const Surface& surface) {
  if (surface.triangles.empty()) throw Error("the surface has no triangles");
  const SoupFaults found = faults(surface);
  const std::string bounds_no_volume = "the surface does not bound a volume: ";
  if (found.border_edges > 0 || !found.manifold()) throw Error(bounds_no_volume + found.str());
  const auto pairs = self_intersections(surface);
  if (pairs.empty()) return;
  const auto& triangle = surface.triangles[static_cast<std::size_t>(pairs.front().first)];
  const Vec3 at =
      (surface.points.row(triangle[0]) + surface.points.row(triangle[1]) + surface.points.row(triangle[2])) / 3;
  throw Error(bounds_no_volume + fmt::format("{} self-intersecting triangle {}, the first near ({:g} {:g} {:g})",
                                             with_commas(static_cast<long long>(pairs.size())),
                                             pairs.size() == 1 ? "pair" : "pairs", at.x(), at.y(), at.z()));
}

Surface collapse_edges(const Surface& surface, CollapseTarget target, std::optional<std::pair<Vec3, Vec3>> keep) {
  Polyhedron polyhedron = polyhedron_of(surface);
  const Kept kept{&polyhedron, keep};
  const Enough enough{target, &polyhedron};
  const sms::Constrained_placement<sms::LindstromTurk_placement<Polyhedron>, Kept> placement(kept);
  sms::edge_collapse(polyhedron, enough, CGAL::parameters::edge_is_constrained_map(kept).get_placement(placement));
  polyhedron.collect_garbage();
  return surface_of(polyhedron);
}

struct NearestPoint::Tree {
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

NearestPoint::NearestPoint(const Surface& surface) : tree_(std::make_unique<Tree>()) {
  for (const auto& [a, b, c] : surface.triangles) {
    const Kernel::Triangle_3 triangle(point_of(surface, a), point_of(surface, b), point_of(surface, c));
    if (!triangle.is_degenerate()) tree_->triangles.push_back(triangle);
  }
  if (tree_->triangles.empty()) throw Error("the surface to project onto has no triangles");
  tree_->tree.rebuild(tree_->triangles.begin(), tree_->triangles.end());
  tree_->tree.accelerate_distance_queries();
}

NearestPoint::~NearestPoint() = default;

Vec3 NearestPoint::operator()(const Vec3& point) const {
  const auto found = tree_->tree.closest_point(Kernel::Point_3(point.x(), point.y(), point.z()));
  return {found.x(), found.y(), found.z()};
}

}  // namespace msml::operators
