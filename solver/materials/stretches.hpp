// SPDX-License-Identifier: GPL-3.0-or-later
// Principal stretches of F, and energies written in them turned into stresses and tangents.
#pragma once
#include "solver/materials/jet.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

/// F = U diag(value) V^T with rotations or reflections U and V, value >= 0, in any order.
template <class T>
struct Stretches {
  Tensor<T> U, V;
  T value[3];
};

/// Turns columns p and q of G and V so that those of G become orthogonal.
template <class T>
void make_orthogonal(Tensor<T>& G, Tensor<T>& V, int p, int q) {
  T alpha{}, beta{}, gamma{};
  for (int i = 0; i < 3; ++i) {
    alpha += G(i, p) * G(i, p);
    beta += G(i, q) * G(i, q);
    gamma += G(i, p) * G(i, q);
  }
  // t = tan of the angle: the smaller root of t^2 + t (beta - alpha)/gamma - 1 = 0.
  const T difference = beta - alpha, size = difference < 0.0 ? T(-difference) : difference;
  const T down = size + root(T(difference * difference + 4.0 * gamma * gamma)) + 1e-300;
  const T t = (difference < 0.0 ? T(-2.0 * gamma) : T(2.0 * gamma)) / down;
  const T c = 1.0 / root(T(1.0 + t * t)), s = c * t;
  for (Tensor<T>* M : {&G, &V})
    for (int i = 0; i < 3; ++i) {
      const T x = (*M)(i, p), y = (*M)(i, q);
      (*M)(i, p) = c * x - s * y;
      (*M)(i, q) = s * x + c * y;
    }
}

/// Singular values and vectors by one-sided Jacobi rotations (Hestenes 1958, doi 10.1137/0106005), which keep the small
/// ones accurate. Columns of U that belong to a stretch 0 are 0.
template <class T>
Stretches<T> stretches_of(const Tensor<T>& F) {
  Stretches<T> s{F, {}, {}};
  for (int i = 0; i < 3; ++i) s.V(i, i) += 1.0;
  for (int sweep = 0; sweep < 6; ++sweep)  // quadratic convergence: 5 suffice in practice
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) make_orthogonal(s.U, s.V, p, q);
  for (int k = 0; k < 3; ++k) {
    s.value[k] = root(T(s.U(0, k) * s.U(0, k) + s.U(1, k) * s.U(1, k) + s.U(2, k) * s.U(2, k)));
    const T inverse = 1.0 / (s.value[k] + 1e-300);
    for (int i = 0; i < 3; ++i) s.U(i, k) *= inverse;
  }
  return s;
}

/// An energy of the three stretches with all that a tangent needs. Pairs are (1, 0), (2, 0), (2, 1).
template <class T>
struct StretchEnergy {
  Jet<T, 3> w;
  T difference[3];  ///< (w_i - w_j)/(s_i - s_j), with its limit at equal stretches
  T sum[3];         ///< (w_i + w_j)/(s_i + s_j)
};

/// Energy, stress and (if wanted) tangent. The stress is U diag(w_i) V^T; the tangent has w_ij between the directions
/// u_i v_i^T, `difference` for (u_i v_j^T + u_j v_i^T)/sqrt 2 and `sum` for (u_i v_j^T - u_j v_i^T)/sqrt 2
/// (Smith, de Goes and Kim 2019, doi 10.1145/3241041).
template <class T>
void respond(const StretchEnergy<T>& energy, const Stretches<T>& s, bool tangent, ResponseOf<T>& out) {
  const Jet<T, 3>& w = energy.w;
  Tensor<T> m[9];  // m[3 i + j] = u_i v_j^T
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) m[3 * i + j](r, c) = s.U(r, i) * s.V(c, j);
  out.energy = w.value;
  for (int k = 0; k < 9; ++k) out.P.c[k] = w.first[0] * m[0].c[k] + w.first[1] * m[4].c[k] + w.first[2] * m[8].c[k];
  if (!tangent) return;
  for (T& entry : out.tangent) entry = T{};
  const auto add = [&](const T& c, const Tensor<T>& x, const Tensor<T>& y) {
    for (int I = 0; I < 9; ++I) {
      const T left = c * x.c[I];
      for (int J = 0; J <= I; ++J) out.tangent[packed_at(I, J)] += left * y.c[J];
    }
  };
  for (int i = 0; i < 3; ++i) {
    Tensor<T> mixed{};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 9; ++k) mixed.c[k] += w.second[w.at(i, j)] * m[4 * j].c[k];
    add(T{} + 1.0, m[4 * i], mixed);
  }
  for (int pair = 0; pair < 3; ++pair) {
    const int i = pair == 0 ? 1 : 2, j = pair == 2 ? 1 : 0;
    Tensor<T> same, opposite;
    for (int k = 0; k < 9; ++k) {
      same.c[k] = m[3 * i + j].c[k] + m[3 * j + i].c[k];
      opposite.c[k] = m[3 * i + j].c[k] - m[3 * j + i].c[k];
    }
    add(0.5 * energy.difference[pair], same, same);
    add(0.5 * energy.sum[pair], opposite, opposite);
  }
}

}  // namespace msml::fe
