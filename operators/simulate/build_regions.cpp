// SPDX-License-Identifier: GPL-3.0-or-later
// Which element belongs to which region.
#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/region_materials.hpp"
#include "operators/simulate/selection.hpp"
#include "solver/registry.hpp"

namespace msml::simulation {
namespace {

/// The region of each cell, -1 = none.
class Owners {
 public:
  Owners(const std::vector<const Record*>& records, const Body& body, Reporter& reporter)
      : records_(records),
        body_(body),
        reporter_(reporter),
        owner_(static_cast<std::size_t>(body.mesh->cell_count()), -1) {
    for (std::size_t i = 0; i < records_.size(); ++i) claim(i);
    if (records_.size() == 1)
      extend();
    else
      refuse_left_over();
    for (std::size_t i = 0; i < records_.size(); ++i) warn_if_empty(i);
  }

  std::vector<int> elements(std::size_t region) const {
    std::vector<int> own;
    std::copy_if(body_.elements.begin(), body_.elements.end(), std::back_inserter(own),
                 [&](int id) { return owner_[static_cast<std::size_t>(id)] == static_cast<int>(region); });
    return own;
  }

 private:
  std::string name(std::size_t region) const { return region_name(*records_[region], region); }

  void claim(std::size_t region) {
    std::map<int, int> taken;
    for (const int id : select_elements(*records_[region], body_)) {
      int& owner = owner_[static_cast<std::size_t>(id)];
      if (owner >= 0) ++taken[owner];
      owner = static_cast<int>(region);
    }
    for (const auto& [earlier, count] : taken)
      reporter_.warn(
          fmt::format("{}: regions '{}' and '{}' both claim {}; the later, '{}', has them. Leave them out of "
                      "the indices of one",
                      located(*records_[region]), name(static_cast<std::size_t>(earlier)), name(region),
                      counted(count, "element"), name(region)));
  }

  std::vector<int> left_over() const {
    std::vector<int> none;
    std::copy_if(body_.elements.begin(), body_.elements.end(), std::back_inserter(none),
                 [&](int id) { return owner_[static_cast<std::size_t>(id)] < 0; });
    return none;
  }

  void extend() {
    const auto none = left_over();
    if (none.empty()) return;
    reporter_.warn(
        fmt::format("{}: the indices of region '{}' leave out {} of {}; as the only region it is extended to "
                    "them. Widen its indices",
                    located(*records_[0]), name(0), with_commas(static_cast<int>(none.size())),
                    counted(static_cast<int>(body_.elements.size()), "element")));
    for (const int id : none) owner_[static_cast<std::size_t>(id)] = 0;
  }

  void refuse_left_over() const {
    const auto none = left_over();
    if (none.empty()) return;
    Eigen::AlignedBox3d box;
    for (const int id : none) box.extend(centroid(*body_.mesh, id));
    throw Error(
        fmt::format("{} of {} belong to no region; their centres lie in {} to {}, the first is element {} at {}. "
                    "Widen the indices of a region",
                    with_commas(static_cast<int>(none.size())),
                    counted(static_cast<int>(body_.elements.size()), "element"), place(box.min()), place(box.max()),
                    none.front(), place(centroid(*body_.mesh, none.front()))),
        records_.empty() ? Location{} : records_.front()->where);
  }

  void warn_if_empty(std::size_t region) const {
    if (elements(region).empty())
      reporter_.warn(fmt::format("{}: region '{}' has no elements. Check its indices, or leave it out",
                                 located(*records_[region]), name(region)));
  }

  const std::vector<const Record*>& records_;
  const Body& body_;
  Reporter& reporter_;
  std::vector<int> owner_;
};

/// The material of a region, which fits particles or elements.
const Record& material_of(const Record& region, bool particles) {
  const Record* material = first_of(region, "material");
  if (material == nullptr) refuse(region, particles ? "has no pointMass" : "has no material");
  check_material(*material, particles);
  return *material;
}

}  // namespace

std::string region_name(const Record& record, std::size_t position) {
  return record.id.empty() ? fmt::format("region{}", position + 1) : record.id;
}

void check_material(const Record& material, bool particles) {
  if (particles && material.tag() != "pointMass") refuse(material, "is no law for particles: they have a pointMass");
  if (!particles && material.tag() == "pointMass")
    refuse(material, "is for a body of particles; elements need a material law");
}

void check_region_indices(const Record& region) {
  const int slot = region.description->find("indices");
  const auto* literal = std::get_if<IndexSetPtr>(&region.values[static_cast<std::size_t>(slot)]);
  if (literal != nullptr && (*literal)->kind == Indexed::faces)
    refuse(region, "indices counts faces; a region needs elements, or nodes whose elements are meant");
}

std::vector<fe::Region> build_regions(const std::vector<const Record*>& records, const Body& body, Reporter& reporter) {
  if (records.empty()) throw Error("the object has no region with a material");
  const Owners owners(records, body, reporter);
  std::vector<fe::Region> regions;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& material = material_of(*records[i], false);
    fe::Region region{.name = region_name(*records[i], i), .law = nullptr, .elements = owners.elements(i)};
    set_material(material, body, region);
    if (const Record* mass = first_of(*records[i], "mass")) set_density(*mass, body, region);
    if (const Record* series = first_of(*records[i], "prony")) set_prony(*series, body, region);
    if (!region.elements.empty()) regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<fe::PointMass> build_masses(const std::vector<const Record*>& records, const Body& body,
                                        Reporter& reporter) {
  if (records.empty()) throw Error("the object has no region with a mass");
  const Owners owners(records, body, reporter);
  std::vector<fe::PointMass> masses;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& material = material_of(*records[i], true);
    if (const Record* mass = first_of(*records[i], "mass"))
      refuse(*mass, "has no meaning for particles; their pointMass says it");  // so is prony, before anything runs
    for (const int element : owners.elements(i))
      masses.push_back({body.mesh->cell(element)[0], make<double>(material)});
  }
  return masses;
}

}  // namespace msml::simulation
