// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that rest in a shape of their own.
#pragma once
#include <string>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {

/// A warning where a body of finite strain rests strained although no load acts and no support has moved: it is
/// tangled, turned inside out or snapped through. Empty otherwise, and where viscous stresses or springs may hold it.
std::string warning_of_other_rest(const Run& run, const Check& check);

}  // namespace msml::fe
