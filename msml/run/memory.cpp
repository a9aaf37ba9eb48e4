// SPDX-License-Identifier: GPL-3.0-or-later
// Reads /proc/self (Linux, proc(5): clear_refs and VmHWM).
#include "msml/run/memory.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace msml {

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

std::size_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) {
      std::size_t kilobytes = 0;
      std::istringstream(line.substr(6)) >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

}  // namespace msml
