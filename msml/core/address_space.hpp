// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of the process: memory and threads.
#pragma once
#include <sys/resource.h>

#include <exception>
#include <string_view>
#include <system_error>

namespace msml {

/// True where the system refuses memory beyond a limit of the process (`ulimit -v`, as batch systems set it). OpenBLAS
/// 0.3 asks for its buffers again and again until it gets them: threads of its own may then never begin.
inline bool address_space_is_limited() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// True if an exception says that the system gives no other thread: the standard library's own, or that of oneTBB.
inline bool lacks_a_thread(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system && system->code() == std::errc::resource_unavailable_try_again) return true;
  return std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
}

}  // namespace msml
