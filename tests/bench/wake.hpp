// SPDX-License-Identifier: GPL-3.0-or-later
// Gets a machine ready to be measured.
#pragma once
#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace msml {

/// Keeps all processors busy for so many seconds, with body() at the start of each thread. A virtual machine lends idle
/// processors to others, and what begins after a rest has only one of them for its first 0.1 to 0.2 s.
template <class Body>
void wake_processors(double seconds, const Body& body) {
  using Clock = std::chrono::steady_clock;
  const auto work = [&] {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    body();
    while (Clock::now() < end) continue;
  };
  std::vector<std::jthread> others;
  for (unsigned t = 1; t < std::max(1u, std::thread::hardware_concurrency()); ++t) others.emplace_back(work);
  work();
}

}  // namespace msml
