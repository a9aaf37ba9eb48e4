// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that sleeps until a signal wakes it.
#include "msml/run/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <thread>

#include "msml/core/atomic_file.hpp"
#include "msml/core/error.hpp"

namespace msml {
namespace {

std::atomic<int> bell = -1;  // the writing end of a pipe: all that a signal handler can reach

void ring(int) {
  const int kept = errno;
  const char byte = 0;
  [[maybe_unused]] const auto written = ::write(bell, &byte, 1);
  errno = kept;
}

/// A signal that the caller of the program ignores stays ignored.
void take(int signal) {
  struct sigaction before {};
  struct sigaction action {};
  if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) return;
  action.sa_handler = ring;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void watch_for_interrupts() {
  int ends[2];
  if (bell >= 0 || ::pipe2(ends, O_CLOEXEC) != 0) return;
  bell = ends[1];
  std::thread([wakes = ends[0]] {
    char byte = 0;
    if (::read(wakes, &byte, 1) != 1) return;
    unlink_temporaries();
    constexpr std::string_view words = "\ninterrupted: finished outputs are kept\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(static_cast<int>(Failure::interrupted));
  }).detach();
  take(SIGINT);
  take(SIGTERM);
}

}  // namespace msml
