// SPDX-License-Identifier: GPL-3.0-or-later
// The law of a region, which may differ from element to element.
#pragma once
#include "msml/core/describe.hpp"
#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// Throws Error for what is wrong with such attributes whatever the mesh is: expressions in time, directions that are
/// expressions, `fields` that is no list of pairs.
void check_sources(const Record& material);

/// Sets `law` of the region from the record of its material and, where attributes are taken from cell fields of the
/// mesh (directions that are a field's name, numbers listed in `fields`), `local_law`. Throws Error for a field that
/// the mesh does not have, that has the wrong number of components, or whose values the law refuses.
void set_material(const Record& material, const Body& body, fe::Region& region);

}  // namespace msml::simulation
