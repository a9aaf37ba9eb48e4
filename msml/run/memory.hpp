// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of this process, from the kernel.
#pragma once
#include <cstddef>

namespace msml {

/// Starts a new measurement of the peak. Only meaningful while one node runs.
void reset_peak_memory();
/// Most resident memory in bytes since the last reset (or the start); 0 where the system does not tell.
std::size_t peak_memory();

/// Memory of this process that is resident now, in bytes; 0 where the system does not tell.
std::size_t resident_memory();
/// The part of it that is code and constants, read from the program's file and its libraries as far as they were used.
std::size_t program_memory();

}  // namespace msml
