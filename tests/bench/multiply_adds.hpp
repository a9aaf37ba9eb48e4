// SPDX-License-Identifier: GPL-3.0-or-later
// The most arithmetic that a processor can do.
#pragma once
#include <cstddef>

namespace msml {

constexpr int multiply_add_chains = 16;                                 ///< that run side by side
constexpr double operations_per_round = 2.0 * 8 * multiply_add_chains;  ///< of multiply_adds()

/// So many rounds of multiply-adds on registers, two operations each; returns something that depends on all.
inline double multiply_adds(int rounds, double term) {
  using Eight = double __attribute__((vector_size(64)));
  Eight x[multiply_add_chains];
  for (int k = 0; k < multiply_add_chains; ++k) x[k] = Eight{} + k;
  const Eight factor = Eight{} + 0.999999, added = Eight{} + 1e-6 * term;
  for (int r = 0; r < rounds; ++r)
    for (Eight& chain : x) chain = chain * factor + added;
  double sum = 0;
  for (const Eight& chain : x) sum += chain[0] + chain[7];
  return sum;
}

}  // namespace msml
