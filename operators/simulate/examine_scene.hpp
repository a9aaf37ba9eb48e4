// SPDX-License-Identifier: GPL-3.0-or-later
// What makes no sense in an object, found before anything is meshed.
#pragma once
#include "msml/core/operator.hpp"

namespace msml::simulation {

/// Tells every fault of the record of a simulation: materials and settings that cannot be built, and combinations of
/// element, law, condition, output and integrator that have no meaning; and warns of what means nothing there. Where
/// the record has open parameters (see Fillings), only what holds for each filling. What depends on the mesh is found
/// later, by build_model and fe::Model::check.
void examine_scene(const Examination& scene);

}  // namespace msml::simulation
