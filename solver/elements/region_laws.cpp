// SPDX-License-Identifier: GPL-3.0-or-later
// Picks the laws of elements.
#include "solver/elements/region_laws.hpp"

#include <utility>

#include "solver/materials/plane_stress.hpp"

namespace msml::fe {
namespace {

std::shared_ptr<const Law> in_plane(const Model& model, std::shared_ptr<const Law> law) {
  return model.plane == Plane::stress && law->components() > 1 ? make_plane_stress(std::move(law)) : law;
}

}  // namespace

BatchLaws laws_of(const Region& region, std::span<const int> elements, std::span<const std::vector<Vec3>> places) {
  if (!region.point_law) return {{region.local_law ? region.local_law(elements) : region.law}};
  BatchLaws batch;
  for (const std::vector<Vec3>& at : places) batch.laws.push_back(region.point_law(elements, at));
  return batch;
}

BatchLaws laws_of(const Model& model, const Region& region, std::span<const int> elements,
                  std::span<const std::vector<Vec3>> places) {
  BatchLaws batch = laws_of(region, elements, places);
  for (auto& law : batch.laws) law = in_plane(model, std::move(law));
  return batch;
}

std::shared_ptr<const Law> law_of_points(const Model& model, const Region& region, int element,
                                         std::span<const Vec3> places) {
  if (region.point_law) return in_plane(model, region.point_law({&element, 1}, places));
  return in_plane(model, region.local_law ? region.local_law({&element, 1}) : region.law);
}

}  // namespace msml::fe
