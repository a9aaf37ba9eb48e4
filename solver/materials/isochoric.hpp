// SPDX-License-Identifier: GPL-3.0-or-later
// Invariants of F without its volume change, J^(-1/3) F.
#pragma once
#include "solver/materials/invariants.hpp"

namespace msml::fe {

/// J^(-n/3) (x + c (J - 1) + 3) - 3 with c = n, of jets x and j = J - 1.
template <int n, class T, int N>
Jet<T, N> isochoric(const Jet<T, N>& x, const Jet<T, N>& j) {
  constexpr double count = n, power = count / 3;
  const T c = j.value, shrunk = exp1m(T(-power * ln1p(c))), q = 1.0 + shrunk;  // q = J^-power
  const T r = q / (1.0 + c), s = r / (1.0 + c);
  const Jet<T, N> factor = chain<T, N>(j, q, -power * r, power * (power + 1) * s);
  // f(j) = J^-power (3 + n j) - 3, whose slope n (1 - power) j J^(-power - 1) vanishes at rest.
  constexpr double m = count * (1 - power);
  const Jet<T, N> rest = chain<T, N>(j, 3.0 * shrunk + count * c * q, m * c * r, m * s * (1.0 - power * c));
  return factor * x + rest;
}

/// J^(-2/3) I1 - 3 from a and j of Invariants (Flory 1961, doi 10.1039/tf9615700829).
template <class T, int N>
Jet<T, N> isochoric_first(const Jet<T, N>& a, const Jet<T, N>& j) {
  return isochoric<2>(a, j);
}

/// J^(-4/3) I2 - 3 from b and j of Invariants.
template <class T, int N>
Jet<T, N> isochoric_second(const Jet<T, N>& b, const Jet<T, N>& j) {
  return isochoric<4>(b, j);
}

}  // namespace msml::fe
