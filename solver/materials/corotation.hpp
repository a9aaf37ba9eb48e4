// SPDX-License-Identifier: GPL-3.0-or-later
// The polar decomposition F = R U at a point, with the derivative of R.
#pragma once
#include "solver/materials/law.hpp"
#include "solver/materials/polar.hpp"

namespace msml::fe {

/// (a + a^T)/2.
template <class T>
Tensor<T> sym(const Tensor<T>& a) {
  Tensor<T> s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s(i, j) = 0.5 * (a(i, j) + a(j, i));
  return s;
}

/// a b, or a^T b.
template <class T>
Tensor<T> product(const Tensor<T>& a, const Tensor<T>& b, bool transpose_a = false, bool transpose_b = false) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      T sum{};
      for (int k = 0; k < 3; ++k) sum += (transpose_a ? a(k, i) : a(i, k)) * (transpose_b ? b(j, k) : b(k, j));
      c(i, j) = sum;
    }
  return c;
}

/// The polar decomposition F = R U of F = I + H, and U - I.
template <class T>
struct Polar {
  Tensor<T> R, strain;
};

/// U - I of F = R U.
template <class T>
Tensor<T> strain_of(const Tensor<T>& R, const Tensor<T>& F) {
  Tensor<T> strain = sym(product(R, F, true));
  for (int i = 0; i < 3; ++i) strain(i, i) -= 1.0;
  return strain;
}

/// The decomposition of I + H, given as H.
template <class T>
Polar<T> decompose(const Tensor<T>& H) {
  const Tensor<T> F = deformation_gradient(H);
  Polar<T> p{polar_rotation(F), {}};
  p.strain = strain_of(p.R, F);
  return p;
}

/// The rotation turns by dR = R [G^-1 w]x, [w]x = R^T dF - dF^T R and G = tr(U) I - U (Chen and Wheeler 1993, doi
/// 10.1007/BF00042491), so that c R has the derivative c T G^-1 T^T, column k of T being R [e_k]x. Returns c G^-1.
template <class T>
Tensor<T> spin_stiffness(const T& c, const Tensor<T>& strain) {
  const T tr_U = trace(strain) + 3.0;
  Tensor<T> G;
  for (int k = 0; k < 9; ++k) G.c[k] = -strain.c[k];
  for (int i = 0; i < 3; ++i) G(i, i) += tr_U - 1.0;
  // G loses rank where the rotation is not unique; there a bounded tangent has to do.
  const T det = determinant(G), size = tr_U * tr_U + 1e-6;
  const T shift = det < 1e-9 * size * root(size) ? 1e-3 * root(size) : T{};
  for (int i = 0; i < 3; ++i) G(i, i) += shift;
  Tensor<T> Z = cofactor(G);
  const T scale = c / determinant(G, Z);
  for (int k = 0; k < 9; ++k) Z.c[k] *= scale;
  return Z;
}

/// stretch I + spherical r r^T + T Z T^T, r = vec R.
template <class T>
void corotated_tangent(const T& stretch, const T& spherical, const Tensor<T>& R, const Tensor<T>& Z, T* A) {
  T spin[9][3] = {}, spin_Z[9][3];
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      spin[3 * i + p][k] = R(i, q);
      spin[3 * i + q][k] = -R(i, p);
    }
  }
  for (int I = 0; I < 9; ++I)
    for (int k = 0; k < 3; ++k) spin_Z[I][k] = spin[I][0] * Z(0, k) + spin[I][1] * Z(1, k) + spin[I][2] * Z(2, k);
  for (int I = 0; I < 9; ++I) {
    for (int J = 0; J <= I; ++J)
      A[packed_at(I, J)] = spherical * R.c[I] * R.c[J] + spin_Z[I][0] * spin[J][0] + spin_Z[I][1] * spin[J][1] +
                           spin_Z[I][2] * spin[J][2];
    A[packed_at(I, I)] += stretch;
  }
}

}  // namespace msml::fe
