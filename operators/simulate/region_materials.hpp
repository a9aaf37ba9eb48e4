// SPDX-License-Identifier: GPL-3.0-or-later
// The law, the density and the relaxation of a region, which may differ from place to place.
#pragma once
#include "msml/core/describe.hpp"
#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// Sets the law of the region from the record of its material: `point_law` where attributes are expressions,
/// `local_law` where they come from cell fields alone. Throws Error as VaryingRecord does, and for what the law
/// refuses at a place.
void set_material(const Record& material, const Body& body, fe::Region& region);

/// Sets the density of the region from the tag mass.
void set_density(const Record& mass, const Body& body, fe::Region& region);

/// Sets the relaxation series of the region from the tag prony: `prony_at` where its numbers vary, and then `prony` to
/// a typical one with the shortest times. Throws Error as VaryingRecord does, and for what the series refuses at a
/// place.
void set_prony(const Record& series, const Body& body, fe::Region& region);

}  // namespace msml::simulation
