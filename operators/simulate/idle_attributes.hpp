// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene says although it means nothing there.
#pragma once
#include "msml/core/operator.hpp"
#include "operators/simulate/surroundings.hpp"

namespace msml::simulation {

/// Tells of each attribute in the record of a simulation and below it that has no meaning beside the others: loadSteps
/// in dynamics, spectralRadius with Newmark. Attributes at their default say nothing and are passed over. `around` has
/// settings.
void find_idle(const Record& args, const Surroundings& around, const std::function<void(const Error&)>& tell);

/// Tells of each table whose times all lie before or after those when its tag acts.
void find_idle_tables(const Record& args, const std::function<void(const Error&)>& tell);

/// True for names in capitals such as SGAUSS_SEIDEL and ILU2, as other programs spell theirs.
bool of_other_program(const std::string& name);

}  // namespace msml::simulation
