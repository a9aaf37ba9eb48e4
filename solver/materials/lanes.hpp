// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that travel eight abreast: the scalar of all loops over quadrature points.
#pragma once
#include <cmath>

namespace msml::fe {

/// Points handled at once. Eight doubles fill one AVX-512 register, two AVX2 registers, four SSE2 registers.
inline constexpr int lanes = 8;

/// `lanes` doubles with elementwise + - * / and comparison; x[i] is lane i.
using Lanes = double __attribute__((vector_size(lanes * sizeof(double))));

inline double root(double x) { return std::sqrt(x); }
/// Elementwise square root.
inline Lanes root(Lanes x) {
  for (int i = 0; i < lanes; ++i) x[i] = std::sqrt(x[i]);
  return x;
}

/// All lanes equal to x.
inline Lanes lanes_of(double x) { return Lanes{} + x; }

/// v[i][j] and v[j][i] change places.
inline void transpose(Lanes (&v)[lanes]) {
  Lanes s[lanes], t[lanes];
  for (int k = 0; k < lanes; k += 2) {
    s[k] = __builtin_shufflevector(v[k], v[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    s[k + 1] = __builtin_shufflevector(v[k], v[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int k = 0; k < lanes; k += 4)
    for (int i = 0; i < 2; ++i) {
      t[k + i] = __builtin_shufflevector(s[k + i], s[k + i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      t[k + i + 2] = __builtin_shufflevector(s[k + i], s[k + i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int k = 0; k < 4; ++k) {
    v[k] = __builtin_shufflevector(t[k], t[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    v[k + 4] = __builtin_shufflevector(t[k], t[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

inline double ln1p(double x) { return std::log1p(x); }
inline double exp1m(double x) { return std::expm1(x); }
#if defined __AVX512F__ && defined __GLIBC__ && __GLIBC_PREREQ(2, 35)
// Eight at once, as glibc's libmvec has them: within two units of the last digit.
extern "C" Lanes eight_ln1p(Lanes) asm("_ZGVeN8v_log1p");
extern "C" Lanes eight_exp1m(Lanes) asm("_ZGVeN8v_expm1");
inline Lanes ln1p(Lanes x) { return eight_ln1p(x); }
inline Lanes exp1m(Lanes x) { return eight_exp1m(x); }
#else
/// Elementwise ln(1 + x), accurate for small x; NaN below -1.
inline Lanes ln1p(Lanes x) {
  for (int i = 0; i < lanes; ++i) x[i] = std::log1p(x[i]);
  return x;
}
/// Elementwise exp(x) - 1, accurate for small x.
inline Lanes exp1m(Lanes x) {
  for (int i = 0; i < lanes; ++i) x[i] = std::expm1(x[i]);
  return x;
}
#endif

/// A 3 x 3 matrix of scalars T, row by row.
template <class T>
struct Tensor {
  T c[9];
  T& operator()(int i, int j) { return c[3 * i + j]; }
  const T& operator()(int i, int j) const { return c[3 * i + j]; }
};

/// F = I + H. Entry by entry, since a copy of so many numbers is a call.
template <class T>
Tensor<T> deformation_gradient(const Tensor<T>& H) {
  Tensor<T> F;
  for (int k = 0; k < 9; ++k) F.c[k] = k % 4 == 0 ? H.c[k] + 1.0 : H.c[k];
  return F;
}

/// Cofactor matrix: cof(A) = det(A) A^-T.
template <class T>
Tensor<T> cofactor(const Tensor<T>& a) {
  Tensor<T> b;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      b(i, j) = a(p, r) * a(q, s) - a(p, s) * a(q, r);
    }
  return b;
}

/// The cross product of tensors: cof(A + B) = cof(A) + A x B + cof(B), so that d cof(A) = A x dA.
template <class T>
Tensor<T> cross(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      c(i, j) = a(p, r) * b(q, s) + a(q, s) * b(p, r) - a(p, s) * b(q, r) - a(q, r) * b(p, s);
    }
  return c;
}

/// det(A) from A and its cofactor matrix.
template <class T>
T determinant(const Tensor<T>& a, const Tensor<T>& cof) {
  return a(0, 0) * cof(0, 0) + a(0, 1) * cof(0, 1) + a(0, 2) * cof(0, 2);
}

template <class T>
T determinant(const Tensor<T>& a) {
  return determinant(a, cofactor(a));
}

template <class T>
T trace(const Tensor<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

/// a : b. Row by row, so that three sums grow at once.
template <class T>
T contract(const Tensor<T>& a, const Tensor<T>& b) {
  T rows[3];
  for (int i = 0; i < 3; ++i) rows[i] = a(i, 0) * b(i, 0) + a(i, 1) * b(i, 1) + a(i, 2) * b(i, 2);
  return rows[0] + rows[1] + rows[2];
}

/// Sum of the squares of all entries.
template <class T>
T square_sum(const Tensor<T>& a) {
  return contract(a, a);
}

}  // namespace msml::fe
