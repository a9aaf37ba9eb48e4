// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that sleeps in sigwait.
#include "msml/run/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>
#include <thread>

#include "msml/core/atomic_file.hpp"
#include "msml/core/error.hpp"

namespace msml {

void watch_for_interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
    unlink_temporaries();
    constexpr std::string_view words = "\ninterrupted: finished outputs are kept\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(static_cast<int>(Failure::interrupted));
  }).detach();
}

}  // namespace msml
