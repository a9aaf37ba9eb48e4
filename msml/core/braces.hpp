// SPDX-License-Identifier: GPL-3.0-or-later
// The braces that a list may stand in.
#pragma once
#include <string>
#include <string_view>

namespace msml {

/// The text without blanks at its ends and without one pair of braces around the rest.
std::string without_braces(std::string_view text);

}  // namespace msml
