// SPDX-License-Identifier: GPL-3.0-or-later
// The quadrature points of all elements in a list.
#pragma once
#include <vector>

#include "solver/elements/assembly.hpp"

namespace msml::fe::testing {

/// What visit_points tells, in the order of Numbering::elements.
inline std::vector<ElementPoints> points_of(const Elements& elements, const Vector& u) {
  std::vector<ElementPoints> found(elements.numbering().elements.size());
  elements.visit_points(u, [&](std::size_t e, const ElementPoints& points) { found[e] = points; });
  return found;
}

}  // namespace msml::fe::testing
