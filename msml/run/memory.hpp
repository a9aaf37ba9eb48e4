// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of this process, from the kernel.
#pragma once
#include <cstddef>

namespace msml {

/// Starts a new measurement of the peak. Only meaningful while one node runs.
void reset_peak_memory();
/// Most resident memory in bytes since the last reset (or the start); 0 where the system does not tell.
std::size_t peak_memory();

/// Resident memory in bytes that the process has written (heap and stacks); 0 where the system does not tell.
std::size_t own_memory();
/// Resident code and constants, read from the program's file and its libraries as far as they were used.
std::size_t program_memory();

}  // namespace msml
