// SPDX-License-Identifier: GPL-3.0-or-later
// Guccione's energy of heart muscle.
#pragma once
#include "solver/materials/fibres.hpp"

namespace msml::fe {

/// Variables (q, e, h, j) of the Green-Lagrange strain E = (C - I)/2: q = E:E, e = g . E g, h = |E g|^2, and j = J - 1.
template <class T>
struct StrainInvariants {
  static constexpr int count = 4;
  static constexpr int volume = 3;
  using Energy = Jet<T, count>;
  Direction<T> g, w, v;  ///< fibre, F g, E g
  Tensor<T> F, E;
  Energy q, e, h, j;

  StrainInvariants(const Invariants<T>& of, const Direction<T>& fibre) : g(fibre), F(of.F()), j() {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        T square{};
        for (int m = 0; m < 3; ++m) square += of.H(m, i) * of.H(m, k);
        E(i, k) = 0.5 * (of.H(i, k) + of.H(k, i) + square);
      }
    w = times(F, g);
    v = times(E, g);
    q = Energy::variable(0, square_sum(E));
    e = Energy::variable(1, g[0] * v[0] + g[1] * v[1] + g[2] * v[2]);
    h = Energy::variable(2, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    j = Energy::variable(3, of.j);
  }
  void slopes(const Invariants<T>& of, Tensor<T> (&d)[count]) const {
    const Direction<T> Fv = times(F, v);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t I = 3 * i + k;
        d[0].c[I] = 2.0 * (F.c[3 * i] * E.c[k] + F.c[3 * i + 1] * E.c[3 + k] + F.c[3 * i + 2] * E.c[6 + k]);
        d[1].c[I] = w[i] * g[k];
        d[2].c[I] = Fv[i] * g[k] + w[i] * v[k];
      }
    d[3] = of.slope_of_j();
  }
  void add_curvature(const Invariants<T>&, const Energy& energy, T* A) const {
    Tensor<T> B{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int m = 0; m < 3; ++m) B(i, k) += F(i, m) * F(k, m);
    const T cq = energy.first[0], ce = energy.first[1], ch = energy.first[2];
    for (int I = 0; I < 9; ++I)
      for (int J = 0; J <= I; ++J) {
        const int i = I / 3, k = I % 3, j1 = J / 3, l = J % 3;
        const T gk = g[static_cast<std::size_t>(k)], gl = g[static_cast<std::size_t>(l)];
        const T wi = w[static_cast<std::size_t>(i)], wj = w[static_cast<std::size_t>(j1)];
        T entry = cq * F(i, l) * F(j1, k) + 0.5 * ch * (gk * (B(i, j1) * gl + F(i, l) * wj) + wi * F(j1, k) * gl);
        if (i == j1)
          entry += 2.0 * cq * E(k, l) + ce * gk * gl +
                   ch * (v[static_cast<std::size_t>(l)] * gk + gl * v[static_cast<std::size_t>(k)]);
        if (k == l) entry += cq * B(i, j1) + 0.5 * ch * wi * wj;
        A[packed_at(I, J)] += entry;
      }
    add_curvature_of_volume<T>(energy.first[3], F, A);
  }
};

/// C/2 (exp(Q) - 1) with Q = bf E_ff^2 + bt (E_ss^2 + E_nn^2 + 2 E_sn^2) + 2 bfs (E_fs^2 + E_fn^2), f along the fibre
/// and s, n across (Guccione, McCulloch and Waldman 1991, doi 10.1115/1.2894084). Q is the same for every choice of s
/// and n: Q = bt q + 2 (bfs - bt) h + (bf + bt - 2 bfs) e^2 in StrainInvariants.
template <class T>
struct Guccione {
  using Variables = StrainInvariants<T>;
  T C, bf, bt, bfs;
  Direction<T> g;

  const Direction<T>& fibre() const { return g; }
  Variables variables(const Invariants<T>& of) const { return {of, g}; }
  Jet<T, 4> operator()(const Variables& x) const {
    const Jet<T, 4> Q = scale<T>(bt, x.q) + scale<T>(2.0 * (bfs - bt), x.h) + scale<T>(bf + bt - 2.0 * bfs, x.e * x.e);
    const T grown = exp1m(Q.value), half = 0.5 * C * (1.0 + grown);
    return chain<T, 4>(Q, 0.5 * C * grown, half, half);
  }
  template <class U, class F>
  Guccione<U> map(F&& f) const {
    return {f(C), f(bf), f(bt), f(bfs), {f(g[0]), f(g[1]), f(g[2])}};
  }
};

}  // namespace msml::fe
