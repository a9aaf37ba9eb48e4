// SPDX-License-Identifier: GPL-3.0-or-later
// Laws and densities made where they are wanted.
#include "operators/simulate/region_materials.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "operators/simulate/records.hpp"
#include "operators/simulate/varying_record.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

using LawPtr = std::shared_ptr<const fe::Law>;

/// Up to eight laws side by side; the last fills the lanes that are left.
LawPtr side_by_side(const Record& material, std::vector<LawPtr> laws) {
  laws.resize(fe::lanes, laws.back());
  LawPtr merged = laws.front()->merged(laws);
  if (!merged) refuse(material, "cannot differ between elements");
  return merged;
}

}  // namespace

void set_material(const Record& material, const Body& body, fe::Region& region) {
  const VaryingRecord record(material, body, region.elements);
  if (region.elements.empty()) return;
  const auto middle = [&](int e) { return centroid(*body.mesh, e); };
  if (record.inside())
    for (const int e : region.elements) make<LawPtr>(record.at(e, middle(e)));  // are all in range?
  const int first = region.elements.front();
  region.law = make<LawPtr>(record.at(first, middle(first)));
  if (record.inside()) {
    region.point_law = [material, record](std::span<const int> elements, std::span<const Vec3> places) {
      std::vector<LawPtr> laws;
      for (std::size_t i = 0; i < places.size(); ++i)
        laws.push_back(make<LawPtr>(record.at(elements[std::min(i, elements.size() - 1)], places[i])));
      return side_by_side(material, std::move(laws));
    };
  } else if (record.varies()) {
    region.local_law = [material, record](std::span<const int> elements) {
      std::vector<LawPtr> laws;
      for (const int e : elements) laws.push_back(make<LawPtr>(record.at(e, Vec3::Zero())));
      return side_by_side(material, std::move(laws));
    };
  }
}

void set_density(const Record& mass, const Body& body, fe::Region& region) {
  const VaryingRecord record(mass, body, region.elements);
  if (region.elements.empty()) return;
  const int first = region.elements.front();
  region.density = make<double>(record.at(first, centroid(*body.mesh, first)));
  if (!record.varies()) return;
  region.density_at = [record](int element, const Vec3& X) { return make<double>(record.at(element, X)); };
}

}  // namespace msml::simulation
