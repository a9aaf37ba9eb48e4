// SPDX-License-Identifier: GPL-3.0-or-later
// All operators, scene tags of the solver and file formats in one call.
#pragma once
#include "msml/core/registry.hpp"

namespace msml {

/// Adds every operator of the build list, every file format, and every tag that the simulation describes.
void add_operators(Registry& registry);

}  // namespace msml
