// SPDX-License-Identifier: GPL-3.0-or-later
// Reads /proc/meminfo and /sys/fs/cgroup.
#include "solver/linear/available_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace msml::fe {
namespace {

constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

std::size_t of_the_machine() {
  std::ifstream info("/proc/meminfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("MemAvailable:")) {
      std::size_t kilobytes = 0;
      if (std::istringstream(line.substr(13)) >> kilobytes) return kilobytes * 1024;
    }
  return unknown;
}

/// A group without a limit says "max".
std::size_t of_the_group() {
  std::size_t most = 0, used = 0;
  if (!(std::ifstream("/sys/fs/cgroup/memory.max") >> most)) return unknown;
  if (!(std::ifstream("/sys/fs/cgroup/memory.current") >> used)) return unknown;
  return most > used ? most - used : 0;
}

}  // namespace

std::size_t available_memory() { return std::min(of_the_machine(), of_the_group()); }

}  // namespace msml::fe
