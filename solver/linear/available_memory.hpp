// SPDX-License-Identifier: GPL-3.0-or-later
// How much a factorisation may take.
#pragma once
#include <cstddef>

namespace msml::fe {

/// Bytes that the process can still take without being ended by the system: what the machine has available (Linux,
/// proc(5): MemAvailable), and what its control group leaves (cgroups(7), version 2). The largest number where neither
/// can be read.
std::size_t available_memory();

}  // namespace msml::fe
