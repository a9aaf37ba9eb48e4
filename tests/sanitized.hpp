// SPDX-License-Identifier: GPL-3.0-or-later
// Whether AddressSanitizer watches, which takes several times the time, keeps freed memory and reserves terabytes.
#pragma once

namespace msml::testing {

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

}  // namespace msml::testing
