// SPDX-License-Identifier: GPL-3.0-or-later
// Laws as a scene would ask for them.
#pragma once
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "solver/registry.hpp"

namespace msml::fe::testing {

/// The law of a tag with some of its attributes.
inline std::shared_ptr<const Law> law_by_name(const std::string& tag,
                                              const std::vector<std::pair<std::string, Value>>& attributes) {
  for (const MaterialFactory& material : materials()) {
    if (material.tag() != tag) continue;
    Record record{.description = &material};
    for (const Slot& slot : material.slots()) {
      record.values.push_back(slot.fallback);
      record.given.push_back(false);
    }
    for (const auto& [name, value] : attributes) {
      const auto slot = static_cast<std::size_t>(material.find(name));
      record.values.at(slot) = convert(value, material.slots()[slot].type);
      record.given.at(slot) = true;
    }
    return material.make(record);
  }
  throw std::runtime_error("no law " + tag);
}

inline std::shared_ptr<const Law> neo_hookean(const std::string& form, double young, double poisson) {
  return law_by_name("neoHookeanMaterial", {{"form", form}, {"youngModulus", young}, {"poissonRatio", poisson}});
}

}  // namespace msml::fe::testing
