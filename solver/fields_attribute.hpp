// SPDX-License-Identifier: GPL-3.0-or-later
// The attribute by which numbers of a tag come from cell fields.
#pragma once
#include <string>

#include "msml/core/describe.hpp"

namespace msml::fe {

/// Adds the attribute `fields`. Whoever builds from the record works it out before: what a tag builds from are numbers.
inline void describe_fields(Description& tag) {
  tag.parameter<std::string>(
      "fields", {.optional = true,
                 .doc = "numbers that differ between elements, as pairs of an attribute and the cell field of the mesh "
                        "that holds it: \"youngModulus=E\"; of a list mu[2]=M its second number, and mu=M all of them, "
                        "with as many components. The attribute itself then is a typical value"});
}

}  // namespace msml::fe
