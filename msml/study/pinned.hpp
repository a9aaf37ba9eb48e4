// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps timings from being disturbed by moves between processors.
#pragma once
#include <sched.h>

namespace msml {

/// While it lives, the calling thread and the threads it starts run on the first `threads` processors that the process
/// may use; afterwards the calling thread may use all of them again.
class Pinned {
 public:
  explicit Pinned(int threads);
  ~Pinned();
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  cpu_set_t before_;
  bool known_;
};

}  // namespace msml
