// SPDX-License-Identifier: GPL-3.0-or-later
// The St. Venant-Kirchhoff energy.
#pragma once
#include "solver/materials/invariants.hpp"

namespace msml::fe {

/// lambda/2 (tr E)^2 + mu E:E, E = (C - I)/2; tr E = a/2 + j, E:E = (tr E)^2 + a - b/2.
template <class T>
struct SaintVenantKirchhoff {
  using Variables = ThreeInvariants<T>;
  T mu, lambda;

  Jet<T, 3> operator()(const Variables& x) const {
    const T trace = 0.5 * x.a.value + x.j.value, modulus = lambda + 2.0 * mu;
    Jet<T, 3> w;
    w.value = 0.5 * modulus * trace * trace + mu * (x.a.value - 0.5 * x.b.value);
    w.first[0] = 0.5 * modulus * trace + mu;
    w.first[1] = -0.5 * mu;
    w.first[2] = modulus * trace;
    w.second[w.at(0, 0)] = 0.25 * modulus;
    w.second[w.at(2, 0)] = 0.5 * modulus;
    w.second[w.at(2, 2)] = modulus;
    return w;
  }
  template <class U, class F>
  SaintVenantKirchhoff<U> map(F&& f) const {
    return {f(mu), f(lambda)};
  }
};

}  // namespace msml::fe
