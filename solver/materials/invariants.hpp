// SPDX-License-Identifier: GPL-3.0-or-later
// Energies as functions of invariants of F, turned into stresses and tangents.
#pragma once
#include "solver/materials/jet.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

/// F = I + H, its cofactor matrix I + K, and the invariants that energies are written in. They are I1 = tr C,
/// I2 = ((tr C)^2 - tr C^2)/2 and J = det F, C = F^T F, combined so that a and b are of second order in H and lose no
/// digits at rest:  a = I1 - 3 - 2 (J - 1),  b = I2 - 3 - 4 (J - 1),  j = J - 1.
template <class T>
struct Invariants {
  Tensor<T> H, K;
  T a, b, j;

  explicit Invariants(const Tensor<T>& gradient) : K(cofactor(gradient)) {
    for (int k = 0; k < 9; ++k) H.c[k] = gradient.c[k];  // entry by entry: see deformation_gradient
    const T tr = trace(H), minors = trace(K), det = determinant(H, K), common = 2.0 * minors;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) K(i, k) -= H(k, i);
      K(i, i) += tr;
    }
    j = tr + minors + det;
    a = square_sum(H) - common - 2.0 * det;
    b = square_sum(K) - common - 4.0 * det;
  }

  Tensor<T> slope_of_a() const {
    Tensor<T> d;
    for (int k = 0; k < 9; ++k) d.c[k] = 2.0 * (H.c[k] - K.c[k]);
    return d;
  }
  /// cof F.
  Tensor<T> slope_of_j() const {
    Tensor<T> d = K;
    for (int i = 0; i < 3; ++i) d(i, i) += 1.0;
    return d;
  }
  Tensor<T> slope_of_b() const {
    const Tensor<T> mixed = cross(K, H), square = cofactor(H);
    const T diagonal = 2.0 * (trace(K) - trace(H));
    Tensor<T> d;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) d(i, k) = 2.0 * (mixed(i, k) - K(k, i) + H(k, i)) - 4.0 * square(i, k);
      d(i, i) += diagonal;
    }
    return d;
  }
  Tensor<T> F() const { return deformation_gradient(H); }
};

/// A += c I (the second derivative of F:F/2).
template <class T>
void add_identity(const T& c, T* A) {
  for (int I = 0; I < 9; ++I) A[packed_at(I, I)] += c;
}

/// A += c d2J/dF2: entry (ik)(jl) is e_ijm e_kln F_mn.
template <class T>
void add_curvature_of_volume(const T& c, const Tensor<T>& F, T* A) {
  for (int i = 1; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const int m = 3 - i - j;
      const double sign = i - j == 1 ? -1 : 1;
      for (int n = 0; n < 3; ++n) {
        const int k = (n + 1) % 3, l = (n + 2) % 3;
        const T entry = (sign * c) * F(m, n);
        A[packed_at(3 * i + k, 3 * j + l)] += entry;
        A[packed_at(3 * i + l, 3 * j + k)] -= entry;
      }
    }
}

/// A += c d2(I2)/dF2, I2 = ((F:F)^2 - C:C)/2.
template <class T>
void add_curvature_of_second(const T& c, const Tensor<T>& F, T* A) {
  Tensor<T> B{}, C{};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int m = 0; m < 3; ++m) {
        B(i, k) += F(i, m) * F(k, m);
        C(i, k) += F(m, i) * F(m, k);
      }
  const T I1 = trace(C), twice = 2.0 * c;
  for (int I = 0; I < 9; ++I)
    for (int J = 0; J <= I; ++J) {
      const int i = I / 3, k = I % 3, j = J / 3, l = J % 3;
      T entry = 2.0 * F.c[I] * F.c[J] - F(i, l) * F(j, k);
      if (i == j && k == l) entry += I1;
      if (i == j) entry -= C(k, l);
      if (k == l) entry -= B(i, j);
      A[packed_at(I, J)] += twice * entry;
    }
}

/// A += sum over x, y of w_xy d_x (d_y)^T, d_x = vec(slopes[x]), w = second derivatives of the energy.
template <class T, int N>
void add_products(const Jet<T, N>& w, const Tensor<T> (&slopes)[N], T* A) {
  Tensor<T> half[N];
  for (int x = 0; x < N; ++x)
    for (int k = 0; k < 9; ++k) {
      half[x].c[k] = w.second[w.at(x, 0)] * slopes[0].c[k];
      for (int y = 1; y < N; ++y) half[x].c[k] += w.second[w.at(x, y)] * slopes[y].c[k];
    }
  for (int I = 0; I < 9; ++I)
    for (int J = 0; J <= I; ++J)
      for (int x = 0; x < N; ++x) A[packed_at(I, J)] += slopes[x].c[I] * half[x].c[J];
}

/// Variables (a, j) of an energy that leaves out I2.
template <class T>
struct TwoInvariants {
  static constexpr int count = 2;
  static constexpr int volume = 1;  ///< which variable is j
  using Energy = Jet<T, count>;
  Energy a, j;

  TwoInvariants(const T& value_a, const T& value_j)
      : a(Energy::variable(0, value_a)), j(Energy::variable(1, value_j)) {}
  explicit TwoInvariants(const Invariants<T>& of) : TwoInvariants(of.a, of.j) {}
  void slopes(const Invariants<T>& of, Tensor<T> (&d)[count]) const {
    d[0] = of.slope_of_a();
    d[1] = of.slope_of_j();
  }
  /// A += sum of w_x d2x/dF2.
  void add_curvature(const Invariants<T>& of, const Energy& w, T* A) const {
    const T c = 2.0 * w.first[0];
    add_identity(c, A);
    add_curvature_of_volume<T>(w.first[1] - c, of.F(), A);
  }
};

/// Variables (a, b, j).
template <class T>
struct ThreeInvariants {
  static constexpr int count = 3;
  static constexpr int volume = 2;
  using Energy = Jet<T, count>;
  Energy a, b, j;

  ThreeInvariants(const T& value_a, const T& value_b, const T& value_j)
      : a(Energy::variable(0, value_a)), b(Energy::variable(1, value_b)), j(Energy::variable(2, value_j)) {}
  explicit ThreeInvariants(const Invariants<T>& of) : ThreeInvariants(of.a, of.b, of.j) {}
  void slopes(const Invariants<T>& of, Tensor<T> (&d)[count]) const {
    d[0] = of.slope_of_a();
    d[1] = of.slope_of_b();
    d[2] = of.slope_of_j();
  }
  void add_curvature(const Invariants<T>& of, const Energy& w, T* A) const {
    const Tensor<T> F = of.F();
    const T c = 2.0 * w.first[0];
    add_identity(c, A);
    add_curvature_of_second(w.first[1], F, A);
    add_curvature_of_volume<T>(w.first[2] - c - 4.0 * w.first[1], F, A);
  }
};

}  // namespace msml::fe
