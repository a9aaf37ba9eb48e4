// SPDX-License-Identifier: GPL-3.0-or-later
// Neo-Hookean energies without their volumetric part.
#pragma once
#include "solver/materials/isochoric.hpp"

namespace msml::fe {

/// mu/2 (I1 - 3) - mu ln J (Bonet and Wood 1997, Nonlinear continuum mechanics).
template <class T>
struct LogNeoHookean {
  using Variables = TwoInvariants<T>;
  T mu;

  Jet<T, 2> operator()(const Variables& x) const {
    const T j = x.j.value, J = 1.0 + j;
    return scale<T>(0.5 * mu, x.a) + Jet<T, 2>::of_variable(1, mu * (j - ln1p(j)), mu * j / J, mu / (J * J));
  }
  template <class U, class F>
  LogNeoHookean<U> map(F&& f) const {
    return {f(mu)};
  }
};

/// mu/2 (I1 - 3) - mu r(J) with r of VolumeMeasure::cubic.
template <class T>
struct CubicNeoHookean {
  using Variables = TwoInvariants<T>;
  T mu;

  Jet<T, 2> operator()(const Variables& x) const {
    const T j = x.j.value;
    return scale<T>(0.5 * mu, x.a) +
           Jet<T, 2>::of_variable(1, mu * j * j * (0.5 - j / 3.0), mu * j * (1.0 - j), mu * (1.0 - 2.0 * j));
  }
  template <class U, class F>
  CubicNeoHookean<U> map(F&& f) const {
    return {f(mu)};
  }
};

/// m/2 (I1 - 3) - m/2 ln((I1 + 1)/4) - 3/4 m (J - 1), m = 4/3 mu: the energy of Smith, de Goes and Kim 2018 (doi
/// 10.1145/3180491, equation 14) less its constant and the square of its volume term, which then is l/2 (J - 1)^2 with
/// l = lambda + 5/6 mu; with these two the small-strain limit is Hooke's law of mu and lambda.
template <class T>
struct StableNeoHookean {
  using Variables = TwoInvariants<T>;
  T mu;  ///< of Hooke's law

  Jet<T, 2> operator()(const Variables& x) const {
    const T m = mu * (4.0 / 3), excess = 0.25 * (x.a.value + 2.0 * x.j.value);  // (I1 - 3)/4
    const T inverse = 1.0 / (1.0 + excess), slope = 0.25 * inverse, curvature = -slope * slope;
    Jet<T, 2> w;  // by hand: sums of the slope by j would leave round-off at rest
    w.value = 0.5 * m * (x.a.value + 0.5 * x.j.value - ln1p(excess));
    w.first[0] = 0.5 * m * (1.0 - slope);
    w.first[1] = 0.25 * m * excess * inverse;
    w.second[0] = -0.5 * m * curvature;
    w.second[1] = -m * curvature;
    w.second[2] = -2.0 * m * curvature;
    return w;
  }
  template <class U, class F>
  StableNeoHookean<U> map(F&& f) const {
    return {f(mu)};
  }
};

/// mu/2 (J^(-2/3) I1 - 3).
template <class T>
struct IsochoricNeoHookean {
  using Variables = TwoInvariants<T>;
  T mu;

  Jet<T, 2> operator()(const Variables& x) const { return scale<T>(0.5 * mu, isochoric_first(x.a, x.j)); }
  template <class U, class F>
  IsochoricNeoHookean<U> map(F&& f) const {
    return {f(mu)};
  }
};

/// neoHookeanMaterial form="stable" with a shear modulus (stress) and Poisson's ratio in (-1, 0.5).
std::shared_ptr<const Law> make_stable_neo_hookean(double shear_modulus, double poisson_ratio);

}  // namespace msml::fe
