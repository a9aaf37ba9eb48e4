// SPDX-License-Identifier: GPL-3.0-or-later
// All material laws of the solver in one call.
#pragma once
#include <memory>
#include <vector>

#include "msml/core/registry.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

using MaterialFactory = Factory<std::shared_ptr<const Law>>;

/// One factory per file in solver/materials that is listed in solver/CMakeLists.txt.
std::vector<MaterialFactory> materials();

/// Adds every material to the registry, category "material"; each is a MaterialFactory.
void describe_materials(Registry& registry);

}  // namespace msml::fe
