// SPDX-License-Identifier: GPL-3.0-or-later
// How far apart two processors are.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace msml {

/// Nanoseconds until a number that one thread writes reaches another that waits for it: the shortest mean of ten
/// attempts. Some tens where both processors share a cache, some hundreds where they do not; a virtual machine may be
/// moved from the one to the other while it runs.
inline double handover() {
  using Clock = std::chrono::steady_clock;
  constexpr int attempts = 10, exchanges = 500;
  alignas(128) std::atomic<int> ball = 0;
  const std::jthread other([&] {
    for (int k = 0; k < attempts * exchanges; ++k) {
      while (ball.load(std::memory_order_acquire) != 2 * k + 1) continue;
      ball.store(2 * k + 2, std::memory_order_release);
    }
  });
  double shortest = 1e9;
  for (int k = 0, attempt = 0; attempt < attempts; ++attempt) {
    const Clock::time_point start = Clock::now();
    for (int last = k + exchanges; k < last; ++k) {
      ball.store(2 * k + 1, std::memory_order_release);
      while (ball.load(std::memory_order_acquire) != 2 * k + 2) continue;
    }
    shortest = std::min(shortest, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return shortest / (2 * exchanges);
}

}  // namespace msml
