// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the tables that a run writes.
#pragma once
#include "tests/verification/cases.hpp"

namespace msml::verification {

/// What `measure` asks of the tables in a folder. Throws std::runtime_error on a table or a column that is not there.
double measured(const Measure& measure, const std::filesystem::path& folder);

}  // namespace msml::verification
