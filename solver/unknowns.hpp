// SPDX-License-Identifier: GPL-3.0-or-later
// The size of a problem that is not solved, or not to its end.
#pragma once
#include "solver/model.hpp"

namespace msml::fe {

/// Free unknowns of a step of the model, an index into Model::steps. Costs as much as setting the elements up.
long unknowns(const Model& model, int step);

}  // namespace msml::fe
