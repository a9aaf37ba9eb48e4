// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for the scene descriptions in a build without the solver.
#include "msml/core/registry.hpp"

namespace msml::operators {

void add_scene_descriptions(Registry&);

void add_scene_descriptions(Registry&) {}

}  // namespace msml::operators
