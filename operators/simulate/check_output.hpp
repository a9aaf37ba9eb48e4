// SPDX-License-Identifier: GPL-3.0-or-later
// What may be asked of a simulation.
#pragma once
#include <string>

#include "msml/core/describe.hpp"
#include "operators/simulate/surroundings.hpp"

namespace msml::simulation {

/// True unless the field is one of solids and the unknown is a number, or the other way round, or it is one of elements
/// and there are particles.
bool has_meaning(const std::string& field, const Surroundings& around);

/// Tells, at the place of an output request, each reason why it has no meaning there: for one of these fields, for a
/// field of elements at nodes, for places in particles, and for sections across particles, scalar problems or the plane
/// of a body. Fields that the scene leaves to the defaults are not looked at, but for those of a probe.
void check_output(const Record& output, const Surroundings& around, const fe::Tell& tell = fe::raise);

}  // namespace msml::simulation
