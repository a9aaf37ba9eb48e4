// SPDX-License-Identifier: GPL-3.0-or-later
// Delaunay refinement of a label grid with CGAL Mesh_3.
#include "operators/cgal_fill_labels.hpp"

#include <CGAL/Labeled_mesh_domain_3.h>

#include <algorithm>
#include <cmath>

#include "operators/cgal_refine.hpp"

namespace msml::operators {
namespace {

using Domain = CGAL::Labeled_mesh_domain_3<refine::Kernel>;
using Tr = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using C3t3 = CGAL::Mesh_complex_3_in_triangulation_3<Tr>;

/// The label whose trilinear weights sum to the most; weights in x, y, z order of the eight corners.
int heaviest(const std::array<std::uint8_t, 8>& labels, double x, double y, double z) {
  std::array<int, 8> known{};
  std::array<double, 8> weight{};
  std::size_t count = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    const double w = ((c & 1) ? x : 1 - x) * ((c & 2) ? y : 1 - y) * ((c & 4) ? z : 1 - z);
    std::size_t k = 0;
    while (k < count && known[k] != labels[c]) ++k;
    if (k == count) known[count++] = labels[c];
    weight[k] += w;
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < count; ++k)
    if (weight[k] > weight[best] || (weight[k] == weight[best] && known[k] < known[best])) best = k;
  return known[best];
}

Mesh refined(const LabelGrid& grid, const std::vector<Seed>& seeds, const MeshingSettings& settings,
             const Watcher& watcher, const Announcer& announce) {
  CGAL::get_default_random() = CGAL::Random(0);
  CGAL::Random random(0);
  const Vec3 extent(grid.spacing.x() * (grid.whole[0] - 1), grid.spacing.y() * (grid.whole[1] - 1),
                    grid.spacing.z() * (grid.whole[2] - 1));
  // Interfaces are located to a fiftieth of a voxel: far below the staircase of the image.
  const double error = std::min(1e-3, 0.04 * grid.spacing.minCoeff() / extent.norm());
  const auto label = [&grid](const refine::Kernel::Point_3& p) { return grid.at(Vec3(p.x(), p.y(), p.z())); };
  const refine::WatchedDomain<Domain> domain(label,
                                             refine::Kernel::Iso_cuboid_3(0, 0, 0, extent.x(), extent.y(), extent.z()),
                                             error, CGAL::Null_subdomain_index(), &random);
  C3t3 c3t3;
  refine::insert_seeds(c3t3, domain, seeds);
  if (c3t3.triangulation().dimension() < 3) return {};
  refine::refine_and_improve(c3t3, domain, refine::criteria<Tr>(settings, watcher), settings, announce);
  return refine::mesh_of(c3t3);
}

}  // namespace

int LabelGrid::at(const Vec3& point) const {
  std::array<int, 3> base;
  std::array<double, 3> part;
  for (int d = 0; d < 3; ++d) {
    const auto i = static_cast<std::size_t>(d);
    const double x = point[d] / spacing[d] - first[i];
    if (!(x >= 0 && x <= size[i] - 1)) return 0;
    base[i] = std::min(static_cast<int>(x), std::max(0, size[i] - 2));
    part[i] = x - base[i];
  }
  const auto nx = static_cast<std::size_t>(size[0]);
  const auto nxy = nx * static_cast<std::size_t>(size[1]);
  const std::uint8_t* v = labels.data() + index(base[0], base[1], base[2]);
  const std::array<std::uint8_t, 8> corners{v[0],   v[1],       v[nx],       v[nx + 1],
                                            v[nxy], v[nxy + 1], v[nxy + nx], v[nxy + nx + 1]};
  if (std::all_of(corners.begin() + 1, corners.end(), [&](std::uint8_t label) { return label == corners[0]; }))
    return corners[0];
  return heaviest(corners, part[0], part[1], part[2]);
}

Mesh fill_labels(const LabelGrid& grid, const std::vector<Seed>& seeds, const MeshingSettings& settings,
                 const Watcher& watcher, const Announcer& announce) {
  return refine::guarded([&] { return refined(grid, seeds, settings, watcher, announce); });
}

}  // namespace msml::operators
