// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in time that make energy out of nothing, or lose it.
#pragma once
#include <string>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {

/// A warning where more than half of the energy of a dynamic run came, at some time, from the time integration, or came
/// and went in one that has no damping: what is held and dissipated beside what was there at the start and what loads
/// brought in. Empty otherwise; where supports move, whose work is only known to the order of the time step; and with
/// viscous stresses.
std::string warning_of_energy_gain(const Run& run);

}  // namespace msml::fe
