// SPDX-License-Identifier: GPL-3.0-or-later
// All operators, scene tags of the solver and file formats in one call.
#pragma once
#include <map>
#include <string>

#include "msml/core/registry.hpp"

namespace msml {

/// Adds every operator of the build list, every file format, and every tag that the simulation describes.
void add_operators(Registry& registry);

/// Versions of the libraries that decide results, and of the compiler, by name.
std::map<std::string, std::string> library_versions();

}  // namespace msml
