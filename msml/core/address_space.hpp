// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the process may take as much memory as the machine has.
#pragma once
#include <sys/resource.h>

namespace msml {

/// True where the system refuses memory beyond a limit of the process (`ulimit -v`, as batch systems set it). OpenBLAS
/// 0.3 asks for its buffers again and again until it gets them: threads of its own may then never begin.
inline bool address_space_is_limited() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace msml
