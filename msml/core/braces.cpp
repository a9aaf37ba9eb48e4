// SPDX-License-Identifier: GPL-3.0-or-later
// The braces that a list may stand in.
#include "msml/core/braces.hpp"

#include "msml/core/value.hpp"

namespace msml {

std::string without_braces(std::string_view text) {
  std::string inner = trimmed(text);
  if (inner.size() >= 2 && inner.front() == '{' && inner.back() == '}') inner = inner.substr(1, inner.size() - 2);
  return inner;
}

}  // namespace msml
