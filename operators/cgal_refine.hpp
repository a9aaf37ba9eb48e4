// SPDX-License-Identifier: GPL-3.0-or-later
// The part of CGAL Mesh_3 that both volume meshers run: seeds, refinement, smoothing, and the way back to a Mesh.
// Included by the two meshing cores only; it takes long to compile.
#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/assertions.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/lloyd_optimize_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/odt_optimize_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <unordered_map>

#include "operators/cgal_meshing.hpp"

namespace msml::operators::refine {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Criteria that decide as CGAL's do, and tell a watcher every few thousand decisions how far the mesh has grown.
template <class Tr, class Base>
class Watched : public Base {
 public:
  Watched(Base base, Watcher watcher) : Base(std::move(base)), watcher_(std::move(watcher)) {}
  template <class Simplex>
  auto operator()(const Tr& tr, const Simplex& simplex) const {
    if (watcher_ && ++*calls_ % 8192 == 0) watcher_(tr.number_of_vertices());
    return Base::operator()(tr, simplex);
  }

 private:
  Watcher watcher_;
  std::shared_ptr<std::size_t> calls_ = std::make_shared<std::size_t>(0);
};

/// What is called now and then inside a pass that tells nothing of its progress, so that it can be ended from outside.
struct Beat {
  std::function<void()> tell;
  std::size_t calls = 0;
  void operator()() {
    if (tell && ++calls % 512 == 0) tell();
  }
};

/// A domain whose test for points inside, which every pass but exudation asks, keeps a beat.
template <class Base>
class WatchedDomain : public Base {
 public:
  using Base::Base;
  auto is_in_domain_object() const {
    return [inside = Base::is_in_domain_object(), beat = beat_](const auto& point) {
      (*beat)();
      return inside(point);
    };
  }
  Beat& beat() const { return *beat_; }

 private:
  std::shared_ptr<Beat> beat_ = std::make_shared<Beat>();
};

/// The measure of slivers that CGAL's own exudation takes, which keeps a beat.
template <class Tr>
class WatchedSlivers : public CGAL::Mesh_3::Min_dihedral_angle_criterion<Tr> {
  using Base = CGAL::Mesh_3::Min_dihedral_angle_criterion<Tr>;

 public:
  WatchedSlivers(const Tr& tr, Beat& beat)
      : Base(CGAL::parameters::default_values_for_mesh_3::exude_sliver_bound, tr), beat_(&beat) {}
  using Base::operator();
  double operator()(const typename Tr::Geom_traits::Tetrahedron_3& tetrahedron) const override {
    (*beat_)();
    return Base::operator()(tetrahedron);
  }

 private:
  Beat* beat_;
};

/// As CGAL::exude_mesh_3, with a beat.
template <class C3t3>
CGAL::Mesh_optimization_return_code exude(C3t3& c3t3, double seconds, Beat& beat) {
  using Slivers = WatchedSlivers<typename C3t3::Triangulation>;
  CGAL::Mesh_3::Slivers_exuder<C3t3, Slivers> exuder(c3t3, Slivers(c3t3.triangulation(), beat));
  exuder.set_time_limit(seconds);
  return exuder();
}

template <class Tr>
using Cells = Watched<Tr, CGAL::Mesh_cell_criteria_3<Tr>>;
template <class Tr>
using Facets = Watched<Tr, CGAL::Mesh_facet_criteria_3<Tr>>;
template <class Tr>
using Criteria = CGAL::Mesh_criteria_3<Tr, CGAL::Mesh_edge_criteria_3<Tr>, Facets<Tr>, Cells<Tr>>;

template <class Tr>
Criteria<Tr> criteria(const MeshingSettings& s, const Watcher& watcher) {
  return Criteria<Tr>(
      CGAL::Mesh_edge_criteria_3<Tr>(s.facet_size),
      Facets<Tr>(CGAL::Mesh_facet_criteria_3<Tr>(s.facet_angle, s.facet_size, s.facet_distance), watcher),
      Cells<Tr>(CGAL::Mesh_cell_criteria_3<Tr>(s.radius_edge, s.cell_size), watcher));
}

/// True if a vertex is nearer than `clear`, or protects a sharp edge with a ball around the point.
template <class Tr, class Point>
bool taken(const Tr& tr, const Point& point, double clear) {
  if (tr.number_of_vertices() == 0) return false;
  const auto nearest = tr.nearest_power_vertex(point);
  const auto& weighted = tr.point(nearest);
  return CGAL::squared_distance(weighted.point(), point) - weighted.weight() <= clear * clear;
}

/// Runs a function; what CGAL finds wrong in itself becomes an internal Error.
template <class F>
Mesh guarded(F function) {
  try {
    return function();
  } catch (const CGAL::Failure_exception& failure) {
    throw Error(std::string("CGAL stopped the meshing: ") + failure.what(), {}, Failure::internal);
  }
}

/// Inserts the points where the seeds cross the surface of the domain; returns how many.
template <class C3t3, class Domain>
std::size_t insert_seeds(C3t3& c3t3, const Domain& domain, const std::vector<Seed>& seeds) {
  using Point = typename C3t3::Triangulation::Bare_point;
  using Weighted = typename C3t3::Triangulation::Weighted_point;
  const auto crossing = domain.construct_intersection_object();
  std::size_t inserted = 0;
  for (const Seed& seed : seeds) {
    const Point from(seed.from.x(), seed.from.y(), seed.from.z()), to(seed.to.x(), seed.to.y(), seed.to.z());
    const auto found = crossing(typename Domain::Segment_3(from, to));
    if (std::get<2>(found) == 0 || taken(c3t3.triangulation(), std::get<0>(found), seed.clear)) continue;
    const auto vertex = c3t3.triangulation().insert(Weighted(std::get<0>(found)));
    if (vertex == typename C3t3::Triangulation::Vertex_handle()) continue;
    c3t3.set_dimension(vertex, 2);
    c3t3.set_index(vertex, std::get<1>(found));
    ++inserted;
  }
  return inserted;
}

/// Refines from what the complex already holds, then runs the passes that the settings ask for.
template <class C3t3, class Domain, class MeshCriteria>
void refine_and_improve(C3t3& c3t3, const WatchedDomain<Domain>& domain, const MeshCriteria& mesh_criteria,
                        const MeshingSettings& s, const Announcer& announce) {
  namespace p = CGAL::parameters;
  constexpr int smoothing_sweeps = 100;
  const auto begin = [&](const std::string& pass) {
    announce(pass, false);
    domain.beat().tell = [&announce, pass] { announce(pass, false); };
  };
  const auto limited = [&](const std::string& pass, const auto& run) {
    begin(pass);
    if (run() == CGAL::TIME_LIMIT_REACHED) announce(pass, true);
  };
  announce("refining", false);
  CGAL::refine_mesh_3(c3t3, domain, mesh_criteria, p::no_reset_c3t3(), p::no_odt(), p::no_lloyd(), p::no_perturb(),
                      p::no_exude());
  if (s.odt) {
    begin("odt");
    CGAL::odt_optimize_mesh_3(c3t3, domain, p::max_iteration_number = smoothing_sweeps);
  }
  if (s.lloyd) {
    begin("lloyd");
    CGAL::lloyd_optimize_mesh_3(c3t3, domain, p::max_iteration_number = smoothing_sweeps);
  }
  if (s.perturb)
    limited("perturbing", [&] { return CGAL::perturb_mesh_3(c3t3, domain, p::time_limit = pass_patience); });
  if (s.exude) limited("exuding", [&] { return exude(c3t3, pass_patience, domain.beat()); });
}

/// The tetrahedra of the complex with the points they use; regions are subdomain indices.
template <class C3t3>
Mesh mesh_of(const C3t3& c3t3) {
  Mesh mesh;
  std::unordered_map<const void*, int> ids;
  std::vector<double> coordinates;
  for (auto cell = c3t3.cells_in_complex_begin(); cell != c3t3.cells_in_complex_end(); ++cell) {
    std::array<int, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [entry, fresh] = ids.try_emplace(&*vertex, static_cast<int>(ids.size()));
      corners[static_cast<std::size_t>(i)] = entry->second;
      if (!fresh) continue;
      const auto& point = c3t3.triangulation().point(vertex);
      coordinates.insert(coordinates.end(), {point.x(), point.y(), point.z()});
    }
    mesh.add_cell(CellKind::tet4, corners.data(), static_cast<int>(c3t3.subdomain_index(cell)));
  }
  mesh.points = Eigen::Map<const Points>(coordinates.data(), static_cast<Eigen::Index>(ids.size()), 3);
  return mesh;
}

}  // namespace msml::operators::refine
