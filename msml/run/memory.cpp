// SPDX-License-Identifier: GPL-3.0-or-later
// Reads /proc/self (Linux, proc(5): clear_refs, VmHWM, RssAnon and RssFile).
#include "msml/run/memory.hpp"

#include <malloc.h>

#include <fstream>
#include <sstream>
#include <string>

namespace msml {
namespace {

/// A line of /proc/self/status, in bytes.
std::size_t status(const std::string& name) {
  std::ifstream lines("/proc/self/status");
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name)) {
      std::size_t kilobytes = 0;
      std::istringstream(line.substr(name.size())) >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

}  // namespace

void reset_peak_memory() {
  ::malloc_trim(0);  // what nodes before have freed is no part of the peak
  std::ofstream("/proc/self/clear_refs") << "5";
}

std::size_t peak_memory() { return status("VmHWM:"); }

std::size_t own_memory() { return status("RssAnon:"); }

std::size_t program_memory() { return status("RssFile:"); }

}  // namespace msml
