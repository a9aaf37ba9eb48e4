// SPDX-License-Identifier: GPL-3.0-or-later
// Processors by sched_setaffinity (Linux).
#include "msml/study/pinned.hpp"

namespace msml {

Pinned::Pinned(int threads) {
  CPU_ZERO(&before_);
  known_ = ::sched_getaffinity(0, sizeof before_, &before_) == 0;
  if (!known_) return;
  cpu_set_t some;
  CPU_ZERO(&some);
  for (int cpu = 0, taken = 0; cpu < CPU_SETSIZE && taken < threads; ++cpu)
    if (CPU_ISSET(cpu, &before_)) CPU_SET(cpu, &some), ++taken;
  ::sched_setaffinity(0, sizeof some, &some);
}

Pinned::~Pinned() {
  if (known_) ::sched_setaffinity(0, sizeof before_, &before_);
}

}  // namespace msml
