// SPDX-License-Identifier: GPL-3.0-or-later
// Every law with every element and integration that the compiler allows.
#pragma once
#include "tests/verification/runs.hpp"

namespace msml::verification {

/// Runs the combinations of matrix.json and writes matrix.md to the results: how many integrations of each law and
/// element ran to the end in balance, which did not, and why combinations are refused. Number of runs that failed.
int write_matrix(const Program& program);

}  // namespace msml::verification
