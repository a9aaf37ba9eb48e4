// SPDX-License-Identifier: GPL-3.0-or-later
// What this machine can do at most: memory bandwidth and multiply-adds, and how far its processors are apart, as one
// line of JSON. `wake GB` wakes it instead.
#include <fmt/format.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/handover.hpp"
#include "tests/bench/wake.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using Lanes = double __attribute__((vector_size(64)));

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Shortest time of `repeats` in which all threads do `work(thread)` together.
template <class Work>
double shortest(int threads, int repeats, const Work& work) {
  std::barrier<> together(threads);
  std::vector<double> times;
  const auto body = [&](int thread) {
    for (int r = 0; r <= repeats; ++r) {  // the first touches the memory
      together.arrive_and_wait();
      const Clock::time_point start = Clock::now();
      work(thread);
      together.arrive_and_wait();
      if (thread == 0 && r > 0) times.push_back(since(start));
    }
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(body, t);
  body(0);
  others.clear();
  return *std::min_element(times.begin(), times.end());
}

/// a = b + 3 c over arrays far larger than the caches, in bytes read and written per second (the triad of McCalpin's
/// STREAM, which does not count the read that a store may cause).
double triad(int threads) {
  constexpr std::size_t length = std::size_t{1} << 24;
  const std::size_t share = length / static_cast<std::size_t>(threads);
  const std::unique_ptr<double[]> a(new double[length]), b(new double[length]), c(new double[length]);
  bool filled = false;
  const auto fill = [&](int thread) {
    const std::size_t begin = static_cast<std::size_t>(thread) * share;
    std::fill(&b[begin], &b[begin] + share, 1.0);
    std::fill(&c[begin], &c[begin] + share, 2.0);
  };
  const auto work = [&](int thread) {
    if (!filled) return fill(thread);
    const std::size_t begin = static_cast<std::size_t>(thread) * share;
    double* const to = &a[begin];
    const double *const x = &b[begin], *const y = &c[begin];
#pragma GCC ivdep
    for (std::size_t i = 0; i < share; ++i) to[i] = x[i] + 3 * y[i];
  };
  shortest(threads, 1, work);
  filled = true;
  const double seconds = shortest(threads, 7, work);
  if (a[share / 2] != 7) return 0;
  return 24.0 * static_cast<double>(share * static_cast<std::size_t>(threads)) / seconds;
}

/// Multiply-adds on registers, two operations each, per second.
double multiply_adds(int threads) {
  constexpr int chains = 16, rounds = 4000000;
  std::vector<double> sums(static_cast<std::size_t>(threads));
  const auto work = [&](int thread) {
    Lanes x[chains];
    for (int k = 0; k < chains; ++k) x[k] = Lanes{} + k;
    const Lanes factor = Lanes{} + 0.999999, term = Lanes{} + 1e-6 * (thread + 1);
    for (int r = 0; r < rounds; ++r)
      for (Lanes& chain : x) chain = chain * factor + term;
    double& sum = sums[static_cast<std::size_t>(thread)];
    for (const Lanes& chain : x) sum += chain[0] + chain[7];
  };
  const double seconds = shortest(threads, 5, work);
  return sums[0] > 0 ? 2.0 * 8 * chains * rounds * threads / seconds : 0;
}

/// A virtual machine lends free memory to others too: touches so much of it.
void wake(double gigabytes) {
  const auto size = static_cast<std::size_t>(1e9 * gigabytes / std::max(1u, std::thread::hardware_concurrency()));
  msml::wake_processors(0.1, [&] {
    const std::unique_ptr<volatile char[]> memory(new volatile char[size]);
    for (std::size_t k = 0; k < size; k += 4096) memory[k] = 1;
  });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "wake") return wake(std::atof(argv[2])), 0;
  fmt::print(
      "{{\"triad_1\": {:.2f}, \"triad_2\": {:.2f}, \"fma_1\": {:.1f}, \"fma_2\": {:.1f}, \"handover_ns\": {:.0f}, "
      "\"processors\": {}}}\n",
      1e-9 * triad(1), 1e-9 * triad(2), 1e-9 * multiply_adds(1), 1e-9 * multiply_adds(2), msml::handover(),
      std::thread::hardware_concurrency());
}
