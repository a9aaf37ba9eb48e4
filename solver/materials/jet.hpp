// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that carry their first and second derivatives by a few variables.
#pragma once

namespace msml::fe {

/// A function of N variables at a point: its value, gradient, and Hessian (lower triangle by rows).
template <class T, int N>
struct Jet {
  T value{};
  T first[N] = {};
  T second[N * (N + 1) / 2] = {};

  static constexpr int at(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

  /// Variable number i with this value.
  static Jet variable(int i, const T& value) {
    Jet x;
    x.value = value;
    x.first[i] += 1.0;
    return x;
  }

  /// A function of variable i alone, from its value and derivatives.
  static Jet of_variable(int i, const T& value, const T& slope, const T& curvature) {
    Jet x;
    x.value = value;
    x.first[i] = slope;
    x.second[at(i, i)] = curvature;
    return x;
  }

  Jet& operator+=(const Jet& y) {
    value += y.value;
    for (int i = 0; i < N; ++i) first[i] += y.first[i];
    for (int k = 0; k < N * (N + 1) / 2; ++k) second[k] += y.second[k];
    return *this;
  }
};

template <class T, int N>
Jet<T, N> operator+(Jet<T, N> x, const Jet<T, N>& y) {
  return x += y;
}

/// A constant times a jet.
template <class T, int N>
Jet<T, N> scale(const T& c, Jet<T, N> x) {
  x.value *= c;
  for (T& d : x.first) d *= c;
  for (T& d : x.second) d *= c;
  return x;
}

template <class T, int N>
Jet<T, N> operator*(const Jet<T, N>& x, const Jet<T, N>& y) {
  Jet<T, N> z;
  z.value = x.value * y.value;
  for (int i = 0; i < N; ++i) z.first[i] = x.value * y.first[i] + x.first[i] * y.value;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) {
      const int k = Jet<T, N>::at(i, j);
      z.second[k] = x.value * y.second[k] + x.second[k] * y.value + x.first[i] * y.first[j] + x.first[j] * y.first[i];
    }
  return z;
}

/// f(x) from f, f' and f'' at x.value.
template <class T, int N>
Jet<T, N> chain(const Jet<T, N>& x, const T& f, const T& slope, const T& curvature) {
  Jet<T, N> z;
  z.value = f;
  for (int i = 0; i < N; ++i) z.first[i] = slope * x.first[i];
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) {
      const int k = Jet<T, N>::at(i, j);
      z.second[k] = slope * x.second[k] + curvature * x.first[i] * x.first[j];
    }
  return z;
}

/// A function f of M jets.
template <class T, int M, int N>
Jet<T, N> compose(const Jet<T, M>& f, const Jet<T, N> (&x)[M]) {
  Jet<T, N> z;
  z.value = f.value;
  for (int m = 0; m < M; ++m) {
    for (int i = 0; i < N; ++i) z.first[i] += f.first[m] * x[m].first[i];
    for (int k = 0; k < N * (N + 1) / 2; ++k) z.second[k] += f.first[m] * x[m].second[k];
    for (int n = 0; n < M; ++n) {
      const T& c = f.second[f.at(m, n)];
      for (int i = 0; i < N; ++i)
        for (int j = 0; j <= i; ++j) z.second[z.at(i, j)] += c * x[m].first[i] * x[n].first[j];
    }
  }
  return z;
}

}  // namespace msml::fe
