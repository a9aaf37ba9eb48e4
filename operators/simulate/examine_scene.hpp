// SPDX-License-Identifier: GPL-3.0-or-later
// What makes no sense in an object, found before anything is meshed.
#pragma once
#include <functional>

#include "msml/core/describe.hpp"

namespace msml::simulation {

/// Hands every fault of the record of a simulation to `fault`: materials and settings that cannot be built, and
/// combinations of element, law and integrator that have no meaning. What depends on the mesh is found later, by
/// build_model and fe::Model::check.
void examine_scene(const Record& args, const std::function<void(const Error&)>& fault);

}  // namespace msml::simulation
