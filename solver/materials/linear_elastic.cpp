// SPDX-License-Identifier: GPL-3.0-or-later
// Linear elasticity written once for every scalar type.
#include "solver/materials/linear_elastic.hpp"

#include <fmt/format.h>

#include "msml/core/error.hpp"
#include "solver/materials/polar.hpp"

namespace msml::fe {
namespace {

struct Lame {
  double mu, lambda;
};

constexpr int packed(int i, int j) { return i * (i + 1) / 2 + j; }

template <class T>
T trace(const Tensor<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

template <class T>
Tensor<T> sym(const Tensor<T>& a) {
  Tensor<T> s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s(i, j) = 0.5 * (a(i, j) + a(j, i));
  return s;
}

/// Hooke's law: 2 mu e + lambda tr(e) I.
template <class T>
Tensor<T> hooke(Lame m, const Tensor<T>& e) {
  Tensor<T> s;
  const T pressure = m.lambda * trace(e);
  for (int k = 0; k < 9; ++k) s.c[k] = 2 * m.mu * e.c[k];
  for (int i = 0; i < 3; ++i) s(i, i) += pressure;
  return s;
}

template <class T>
T contract(const Tensor<T>& a, const Tensor<T>& b) {
  T sum = a.c[0] * b.c[0];
  for (int k = 1; k < 9; ++k) sum += a.c[k] * b.c[k];
  return sum;
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

template <class T>
Polar<T> decompose(Tensor<T> F) {
  for (int i = 0; i < 3; ++i) F(i, i) += 1.0;
  Polar<T> p{polar_rotation(F), {}};
  p.strain = sym(product(p.R, F, true));
  for (int i = 0; i < 3; ++i) p.strain(i, i) -= 1.0;
  return p;
}

/// dw/d(skew part): with dR = R [G^-1 w]x, [w]x = R^T dF - dF^T R and G = tr(U) I - U, the rotation adds
/// c T G^-1 T^T to the tangent, c = lambda tr(U - I) - 2 mu, column k of T being R [e_k]x. Returns c G^-1.
template <class T>
Tensor<T> spin_stiffness(Lame m, const Tensor<T>& strain) {
  const T tr = trace(strain), tr_U = tr + 3.0;
  Tensor<T> G;
  for (int k = 0; k < 9; ++k) G.c[k] = -strain.c[k];
  for (int i = 0; i < 3; ++i) G(i, i) += tr_U - 1.0;
  // G loses rank where the rotation is not unique; there a bounded tangent has to do.
  const T det = determinant(G), size = tr_U * tr_U + 1e-6;
  const T shift = det < 1e-9 * size * root(size) ? 1e-3 * root(size) : T{};
  for (int i = 0; i < 3; ++i) G(i, i) += shift;
  Tensor<T> Z = cofactor(G);
  const T scale = (m.lambda * tr - 2 * m.mu) / determinant(G, Z);
  for (int k = 0; k < 9; ++k) Z.c[k] *= scale;
  return Z;
}

/// 2 mu I + lambda r r^T + T Z T^T, r = vec R.
template <class T>
void corotated_tangent(Lame m, const Tensor<T>& R, const Tensor<T>& Z, T* A) {
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
      A[packed(I, J)] = m.lambda * R.c[I] * R.c[J] + spin_Z[I][0] * spin[J][0] + spin_Z[I][1] * spin[J][1] +
                        spin_Z[I][2] * spin[J][2];
    A[packed(I, I)] += 2 * m.mu;
  }
}

/// The constant tangent of small strain: dsigma_ik/dH_jl = mu (d_ij d_kl + d_il d_kj) + lambda d_ik d_jl.
template <class T>
void small_tangent(Lame m, T* A) {
  for (int I = 0; I < 9; ++I)
    for (int J = 0; J <= I; ++J) {
      const int i = I / 3, k = I % 3, j = J / 3, l = J % 3;
      A[packed(I, J)] = T{} + (m.mu * ((i == j && k == l) + (i == l && k == j)) + m.lambda * (i == k && j == l));
    }
}

class LinearLaw final : public Law {
 public:
  explicit LinearLaw(const LinearElastic& data)
      : data_(data),
        lame_{data.youngs_modulus / (2 * (1 + data.poisson_ratio)),
              data.youngs_modulus * data.poisson_ratio / ((1 + data.poisson_ratio) * (1 - 2 * data.poisson_ratio))} {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i)
      if (data_.strain == Strain::small)
        small(want, gradients[i], responses[i]);
      else
        corotated(want, gradients[i], responses[i]);
  }

  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Measures& out = measures[i];
      if (data_.strain == Strain::small) {
        out.strain = sym(gradients[i]);
        out.cauchy = hooke(lame_, out.strain);
        out.energy = 0.5 * contract(out.cauchy, out.strain);
      } else {
        const auto [R, strain] = decompose(gradients[i]);
        const Tensor<Lanes> stress = hooke(lame_, strain);
        out.strain = strain;
        out.energy = 0.5 * contract(stress, strain);
        out.cauchy = sym(product(product(R, stress), R, false, true));
      }
    }
  }

  std::string name() const override { return "linearElasticMaterial"; }
  double poisson_ratio() const override { return data_.poisson_ratio; }
  double shear_modulus() const override { return lame_.mu; }
  bool exact_tangent() const override { return data_.strain == Strain::small || exact(Want::tangent); }
  bool small_strain() const override { return data_.strain == Strain::small; }

 private:
  bool exact(Want want) const {
    return (want == Want::tangent && data_.tangent != TangentKind::rotated) ||
           (want == Want::single_tangent && data_.tangent == TangentKind::exact);
  }

  void small(Want want, const Gradients& H, Response& out) const {
    const Tensor<Lanes> e = sym(H);
    out.P = hooke(lame_, e);
    out.energy = 0.5 * contract(out.P, e);
    if (want != Want::stress) small_tangent(lame_, out.tangent);
  }

  void corotated(Want want, const Gradients& H, Response& out) const {
    const auto [R, strain] = decompose(H);
    const Tensor<Lanes> stress = hooke(lame_, strain);
    out.energy = 0.5 * contract(stress, strain);
    out.P = product(R, stress);
    if (want == Want::stress) return;
    if (exact(want)) {
      corotated_tangent(lame_, R, spin_stiffness(lame_, strain), out.tangent);
    } else {
      Tensor<Lanes> Z{};
      for (int i = 0; i < 3; ++i) Z(i, i) -= lame_.mu;
      corotated_tangent(lame_, R, Z, out.tangent);
    }
  }

  LinearElastic data_;
  Lame lame_;
};

}  // namespace

std::shared_ptr<const Law> make_linear_elastic(const LinearElastic& data) {
  if (!positive().contains(data.youngs_modulus))
    throw Error(fmt::format("youngModulus = {} is not > 0", data.youngs_modulus));
  if (!open(-1, 0.5).contains(data.poisson_ratio))
    throw Error(fmt::format("poissonRatio = {} is not in (-1, 0.5)", data.poisson_ratio));
  return std::make_shared<LinearLaw>(data);
}

Factory<std::shared_ptr<const Law>> linear_elastic_material() {
  Factory<std::shared_ptr<const Law>> material(
      "linearElasticMaterial", "material",
      "Isotropic linear elasticity, co-rotated with each quadrature point or in small strain.");
  material.source("stress R (2 mu (U - I) + lambda tr(U - I) I); rotation by signed polar decomposition");
  material.note("MSML's only working backend computed co-rotated linear elasticity under this name; so does this.");
  const auto young =
      material.parameter("youngModulus", {.unit = "stress", .range = positive(), .doc = "Young's modulus"});
  const auto poisson = material.parameter("poissonRatio", {.range = open(-1, 0.5), .doc = "Poisson's ratio"});
  const auto strain = material.parameter<std::string>(
      "strain", {.fallback = "corotated",
                 .choices = {"corotated", "small"},
                 .doc = "corotated follows large rotations at small strain; small is linear, for small rotations"});
  const auto tangent = material.parameter<std::string>(
      "tangent", {.optional = true,
                  .choices = {"exact", "rotated"},
                  .doc = "corotated only: the derivative of the stress, or R K R^T, which is never indefinite. Absent: "
                         "exact, but rotated with one linear solve per step"});
  material.build([=](const Record& record) {
    LinearElastic data{.youngs_modulus = record[young], .poisson_ratio = record[poisson]};
    data.strain = record[strain] == "small" ? Strain::small : Strain::corotated;
    data.tangent = !record.has(tangent)           ? TangentKind::automatic
                   : record[tangent] == "rotated" ? TangentKind::rotated
                                                  : TangentKind::exact;
    return make_linear_elastic(data);
  });
  return material;
}

}  // namespace msml::fe
