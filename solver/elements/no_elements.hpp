// SPDX-License-Identifier: GPL-3.0-or-later
// Models of point masses alone.
#pragma once
#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// Unknowns at the point masses of a model without elements, and the links between them.
std::unique_ptr<Elements> make_no_elements(const Model& model);

}  // namespace msml::fe
