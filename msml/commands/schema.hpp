// SPDX-License-Identifier: GPL-3.0-or-later
// The XML schema of the language, derived from the descriptions.
#pragma once
#include <string>

#include "msml/core/registry.hpp"

namespace msml {

/// XSD 1.0 for editors: tags, attributes, choices, ranges and documentation. A reference ${…} is allowed wherever a
/// value is. The compiler checks more than a schema can.
std::string schema_text(const Registry& registry);

}  // namespace msml
