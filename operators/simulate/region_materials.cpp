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
  if (record.inside() || record.lists())
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

void set_prony(const Record& series, const Body& body, fe::Region& region) {
  VaryingRecord::check(series);
  const VaryingRecord record(series, body, region.elements);
  if (region.elements.empty()) return;
  const auto at = [record, mesh = body.mesh](int element, const Vec3& X) {
    try {
      return make<fe::Prony>(record.at(element, X));
    } catch (const Error& error) {
      throw Error(fmt::format("{}, in element {} at {}", error.what(), element, place(X)), error.where());
    }
  };
  if (!record.varies()) {
    region.prony = make<fe::Prony>(series);
    return;
  }
  for (const int e : region.elements) {
    const fe::Prony here = at(e, centroid(*body.mesh, e));
    if (region.prony.g.empty()) region.prony = here;
    for (std::size_t i = 0; i < here.tau.size(); ++i) region.prony.tau[i] = std::min(region.prony.tau[i], here.tau[i]);
  }
  region.prony_at = at;
}

}  // namespace msml::simulation
