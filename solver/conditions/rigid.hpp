// SPDX-License-Identifier: GPL-3.0-or-later
// Finds parts of a body that nothing holds.
#pragma once
#include "solver/model.hpp"

namespace msml::fe {

/// Throws Error if a connected part of the body keeps a rigid motion under the step's supports: it names the place of
/// the part and the number of free motions. A part is connected through shared nodes.
void check_held(const Model& model, const Step& step);

}  // namespace msml::fe
