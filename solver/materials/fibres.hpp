// SPDX-License-Identifier: GPL-3.0-or-later
// Energies of fibres, and the invariants they are written in.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "solver/materials/isochoric.hpp"
#include "solver/materials/volumetric.hpp"

namespace msml::fe {

/// A unit vector, the direction of a fibre in the reference configuration.
template <class T>
using Direction = std::array<T, 3>;

/// The three numbers of an attribute that gives a direction; empty where it is anything else, such as a field's name.
std::vector<double> direction_numbers(const std::string& text);

/// A g.
template <class T>
Direction<T> times(const Tensor<T>& A, const Direction<T>& g) {
  Direction<T> w;
  for (std::size_t i = 0; i < 3; ++i) w[i] = A.c[3 * i] * g[0] + A.c[3 * i + 1] * g[1] + A.c[3 * i + 2] * g[2];
  return w;
}

/// Variables (a, j, f1, f2) with a and j of Invariants and f = g . C g - 1 of two fibres g.
template <class T>
struct FibreInvariants {
  static constexpr int count = 4;
  static constexpr int volume = 1;
  using Energy = Jet<T, count>;
  Direction<T> g[2];
  Energy a, j, f[2];

  FibreInvariants(const Invariants<T>& of, const Direction<T>& first, const Direction<T>& second)
      : g{first, second}, a(Energy::variable(0, of.a)), j(Energy::variable(1, of.j)) {
    for (int k = 0; k < 2; ++k) {
      const Direction<T> h = times(of.H, g[k]);
      T sum{};
      for (std::size_t i = 0; i < 3; ++i) sum += h[i] * (2.0 * g[k][i] + h[i]);
      f[k] = Energy::variable(2 + k, sum);
    }
  }
  void slopes(const Invariants<T>& of, Tensor<T> (&d)[count]) const {
    d[0] = of.slope_of_a();
    d[1] = of.slope_of_j();
    for (int fibre = 0; fibre < 2; ++fibre) {
      const Direction<T> w = times(of.F(), g[fibre]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) d[2 + fibre].c[3 * i + k] = 2.0 * w[i] * g[fibre][k];
    }
  }
  void add_curvature(const Invariants<T>& of, const Energy& w, T* A) const {
    const T c = 2.0 * w.first[0];
    add_identity(c, A);
    add_curvature_of_volume<T>(w.first[1] - c, of.F(), A);
    for (std::size_t fibre = 0; fibre < 2; ++fibre)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l <= k; ++l)
            A[packed_at(3 * i + k, 3 * i + l)] += 2.0 * w.first[2 + fibre] * g[fibre][static_cast<std::size_t>(k)] *
                                                  g[fibre][static_cast<std::size_t>(l)];
  }
};

/// k1/(2 k2) (exp(k2 <x>^2) - 1), <x> = max(x, 0): fibres that bear tension alone.
template <class T>
Function<T> fibre_energy(const T& k1, const T& k2, const T& stretch) {
  const T x = stretch > 0.0 ? stretch : T{}, grown = exp1m(T(k2 * x * x)), e = 1.0 + grown;
  const T on = stretch > 0.0 ? T(T{} + 1.0) : T{};
  return {0.5 * k1 / k2 * grown, k1 * x * e, on * k1 * e * (1.0 + 2.0 * k2 * x * x)};
}

/// Neo-Hookean matrix mu/2 (I1 - 3) - mu ln J with fibres of energy k1/(2 k2) (exp(k2 <g . C g - 1>^2) - 1).
template <class T>
struct TransverselyIsotropic {
  using Variables = FibreInvariants<T>;
  T mu, k1, k2;
  Direction<T> g;

  const Direction<T>& fibre() const { return g; }
  Variables variables(const Invariants<T>& of) const { return {of, g, g}; }
  Jet<T, 4> operator()(const Variables& x) const {
    const T j = x.j.value, J = 1.0 + j;
    const Function<T> fibre = fibre_energy(k1, k2, x.f[0].value);
    return scale<T>(0.5 * mu, x.a) + Jet<T, 4>::of_variable(1, mu * (j - ln1p(j)), mu * j / J, mu / (J * J)) +
           Jet<T, 4>::of_variable(2, fibre.value, fibre.slope, fibre.curvature);
  }
  template <class U, class F>
  TransverselyIsotropic<U> map(F&& f) const {
    return {f(mu), f(k1), f(k2), {f(g[0]), f(g[1]), f(g[2])}};
  }
};

/// mu/2 (J^(-2/3) I1 - 3) + sum over two fibres of k1/(2 k2) (exp(k2 <E>^2) - 1),
/// E = kappa (J^(-2/3) I1 - 3) + (1 - 3 kappa) (J^(-2/3) g . C g - 1) (Gasser, Ogden and Holzapfel 2006, doi
/// 10.1098/rsif.2005.0073); kappa from 0, all fibres along g, to 1/3, in all directions.
template <class T>
struct HolzapfelGasserOgden {
  using Variables = FibreInvariants<T>;
  T mu, k1, k2, kappa;
  T second;  ///< 1, or 0 where there is one fibre only
  Direction<T> g1, g2;

  const Direction<T>& fibre() const { return g1; }
  Variables variables(const Invariants<T>& of) const { return {of, g1, g2}; }
  Jet<T, 4> operator()(const Variables& x) const {
    const T j = x.j.value, shrunk = exp1m(T(-2.0 / 3 * ln1p(j))), q = 1.0 + shrunk, r = q / (1.0 + j);
    const Jet<T, 4> less = chain<T, 4>(x.j, shrunk, -2.0 / 3 * r, 10.0 / 9 * r / (1.0 + j));  // J^(-2/3) - 1
    const Jet<T, 4> first = isochoric_first(x.a, x.j);
    Jet<T, 4> w = scale<T>(0.5 * mu, first);
    for (int k = 0; k < 2; ++k) {
      const Jet<T, 4> along = less * x.f[k] + x.f[k] + less;
      const Jet<T, 4> E = scale<T>(kappa, first) + scale<T>(1.0 - 3.0 * kappa, along);
      const Function<T> fibre = fibre_energy<T>(k == 0 ? k1 : T(k1 * second), k2, E.value);
      w += chain(E, fibre.value, fibre.slope, fibre.curvature);
    }
    return w;
  }
  template <class U, class F>
  HolzapfelGasserOgden<U> map(F&& f) const {
    return {f(mu), f(k1), f(k2), f(kappa), f(second), {f(g1[0]), f(g1[1]), f(g1[2])}, {f(g2[0]), f(g2[1]), f(g2[2])}};
  }
};

}  // namespace msml::fe
