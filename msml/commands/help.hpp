// SPDX-License-Identifier: GPL-3.0-or-later
// Texts derived from the descriptions: help for one tag, and lists of what there is.
#pragma once
#include <string>

#include "msml/core/registry.hpp"

namespace msml {

/// Everything known of the tags with this name. Throws Error with the nearest name if there is none.
std::string help_text(const Registry& registry, const std::string& tag);

/// One line per operator, material, constraint, load, output, …; `category` limits the list ("" = all). Throws Error
/// for an unknown category.
std::string list_text(const Registry& registry, const std::string& category);

}  // namespace msml
