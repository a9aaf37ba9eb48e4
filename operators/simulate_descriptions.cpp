// SPDX-License-Identifier: GPL-3.0-or-later
// The tags inside a scene: materials, constraints, loads, solvers and output requests.
#include "msml/core/registry.hpp"

namespace msml::operators {

void add_scene_descriptions(Registry&);

void add_scene_descriptions(Registry&) {}

}  // namespace msml::operators
