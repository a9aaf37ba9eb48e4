// SPDX-License-Identifier: GPL-3.0-or-later
// Linear elasticity written once for every scalar type.
#include "solver/materials/linear_elastic.hpp"

#include <fmt/format.h>

#include "msml/core/error.hpp"
#include "solver/materials/clamped.hpp"
#include "solver/materials/corotation.hpp"

namespace msml::fe {
namespace {

struct Lame {
  Lanes mu, lambda;
};

/// Hooke's law: 2 mu e + lambda tr(e) I.
Tensor<Lanes> hooke(const Lame& m, const Tensor<Lanes>& e) {
  Tensor<Lanes> s;
  const Lanes pressure = m.lambda * trace(e);
  for (int k = 0; k < 9; ++k) s.c[k] = 2.0 * m.mu * e.c[k];
  for (int i = 0; i < 3; ++i) s(i, i) += pressure;
  return s;
}

/// What Hooke's law turned by R makes of F = I + H = R U. As |U - I| = |F - R| and tr(U - I) = R : (F - R), nobody
/// needs U: W = mu |F - R|^2 + lambda/2 (R : (F - R))^2 and P = 2 mu (F - R) + lambda R : (F - R) R.
/// Returns R.
template <class Out>
Tensor<Lanes> turn(const Lame& m, const Tensor<Lanes>& H, Out& out) {
  const Tensor<Lanes> F = deformation_gradient(H), R = polar_rotation(F);
  Tensor<Lanes> D;
  for (int k = 0; k < 9; ++k) D.c[k] = F.c[k] - R.c[k];
  const Lanes volume = contract(R, D), pressure = m.lambda * volume;
  out.energy = m.mu * square_sum(D) + 0.5 * pressure * volume;
  for (int k = 0; k < 9; ++k) out.P.c[k] = 2.0 * m.mu * D.c[k] + pressure * R.c[k];
  return R;
}

/// The constant tangent of small strain: dsigma_ik/dH_jl = mu (d_ij d_kl + d_il d_kj) + lambda d_ik d_jl.
void small_tangent(const Lame& m, Lanes* A) {
  for (int I = 0; I < 9; ++I)
    for (int J = 0; J <= I; ++J) {
      const int i = I / 3, k = I % 3, j = J / 3, l = J % 3;
      const double shear = (i == j && k == l) + (i == l && k == j), volume = i == k && j == l;
      A[packed_at(I, J)] = shear * m.mu + volume * m.lambda;
    }
}

/// Whether the tangent is the derivative of the stress in the corotated law.
bool wants_exact(const LinearElastic& data, Want want) {
  return (want == Want::tangent && data.tangent != TangentKind::rotated) ||
         (want == Want::single_tangent && data.tangent == TangentKind::exact);
}

/// tr e as if it were an energy: tr H, or tr(U - I).
class TraceConstraint final : public Law {
 public:
  explicit TraceConstraint(const LinearElastic& data) : data_(data) {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    const bool small = data_.strain == Strain::small;
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Response& out = responses[i];
      const Polar<Lanes> p = small ? Polar<Lanes>{Tensor<Lanes>{}, sym(gradients[i])} : decompose(gradients[i]);
      out.energy = trace(p.strain);
      out.P = p.R;
      for (int k = 0; k < 3 && small; ++k) out.P(k, k) += 1.0;
      if (want == Want::stress) continue;
      const bool exact = !small && wants_exact(data_, want);
      corotated_tangent(Lanes{}, Lanes{}, p.R, exact ? spin_stiffness(lanes_of(1), p.strain) : Tensor<Lanes>{},
                        out.tangent);
    }
  }
  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const bool small = data_.strain == Strain::small;
      const Tensor<Lanes> strain = small ? sym(gradients[i]) : decompose(gradients[i]).strain;
      measures[i] = {.cauchy = {}, .strain = strain, .energy = trace(strain)};
      for (int k = 0; k < 3; ++k) measures[i].cauchy(k, k) += 1.0;  // R I R^T
    }
  }
  std::string name() const override { return "trace"; }
  double poisson_ratio() const override { return 0; }
  double shear_modulus() const override { return 0; }
  bool exact_tangent() const override { return data_.strain == Strain::small || wants_exact(data_, Want::tangent); }
  /// The polar rotation jumps where a stretch changes sign.
  bool survives_inversion() const override { return data_.strain == Strain::small; }
  bool small_strain() const override { return data_.strain == Strain::small; }

 private:
  LinearElastic data_;
};

class LinearLaw final : public Law {
 public:
  LinearLaw(const LinearElastic& data, const Lame& lame) : data_(data), lame_(lame) {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i)
      if (data_.strain == Strain::small)
        small(want, gradients[i], responses[i]);
      else
        corotated(want, gradients[i], responses[i]);
  }

  bool evaluate_rotated(Want want, std::span<const Gradients> gradients,
                        std::span<RotatedResponse> responses) const override {
    if (want == Want::stress || data_.strain == Strain::small || wants_exact(data_, want)) return false;
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      RotatedResponse& out = responses[i];
      const Tensor<Lanes> R = turn(lame_, gradients[i], out);
      for (int k = 0; k < 9; ++k) out.R.c[k] = R.c[k];
      out.mu = lame_.mu;
      out.lambda = lame_.lambda;
    }
    return true;
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
  double shear_modulus() const override { return lame_.mu[0]; }
  bool exact_tangent() const override { return data_.strain == Strain::small || wants_exact(data_, Want::tangent); }
  bool small_strain() const override { return data_.strain == Strain::small; }
  /// The polar rotation jumps where a stretch changes sign.
  bool survives_inversion() const override { return data_.strain == Strain::small || data_.continued; }
  /// g = tr e, with modulus lambda.
  std::optional<Split> split() const override {
    return Split{.rest = std::make_shared<LinearLaw>(data_, Lame{lame_.mu, {}}),
                 .constraint = std::make_shared<TraceConstraint>(data_),
                 .modulus = lame_.lambda};
  }
  std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> others) const override {
    Lame mixed = lame_;
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const auto* other = dynamic_cast<const LinearLaw*>(others[lane].get());
      if (other == nullptr || other->data_.strain != data_.strain || other->data_.tangent != data_.tangent) return {};
      mixed.mu[lane] = other->lame_.mu[lane];
      mixed.lambda[lane] = other->lame_.lambda[lane];
    }
    return std::make_shared<LinearLaw>(data_, mixed);
  }

 private:
  void small(Want want, const Gradients& H, Response& out) const {
    const Tensor<Lanes> e = sym(H);
    out.P = hooke(lame_, e);
    out.energy = 0.5 * contract(out.P, e);
    if (want != Want::stress) small_tangent(lame_, out.tangent);
  }

  void corotated(Want want, const Gradients& H, Response& out) const {
    const Tensor<Lanes> R = turn(lame_, H, out);
    if (want == Want::stress) return;
    Tensor<Lanes> Z{};
    if (wants_exact(data_, want)) {
      const Tensor<Lanes> strain = strain_of(R, deformation_gradient(H));
      Z = spin_stiffness(lame_.lambda * trace(strain) - 2.0 * lame_.mu, strain);
    } else {
      for (int i = 0; i < 3; ++i) Z(i, i) -= lame_.mu;
    }
    corotated_tangent<Lanes>(2.0 * lame_.mu, lame_.lambda, R, Z, out.tangent);
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
  const double E = data.youngs_modulus, nu = data.poisson_ratio;
  return std::make_shared<LinearLaw>(data,
                                     Lame{lanes_of(E / (2 * (1 + nu))), lanes_of(E * nu / ((1 + nu) * (1 - 2 * nu)))});
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
  const InversionKeys inversion = describe_inversion(material);
  material.note(
      "The corotated law is quadratic in the signed principal stretches, so that its continuation below clampedBelow "
      "is "
      "the law itself: with inversion = \"clamped\" the energy is the same, but states that are inside out are gone "
      "through. Small strain has no stretches to clamp.");
  material.build([=](const Record& record) {
    if (record[inversion.inversion] == "clamped" && record[strain] == "small")
      throw Error(fmt::format("{}: inversion = \"clamped\" is about principal stretches, which strain = \"small\" does "
                              "not have. Leave it out, or take strain = \"corotated\"",
                              record.tag()),
                  record.where);
    LinearElastic data{.youngs_modulus = record[young], .poisson_ratio = record[poisson]};
    data.strain = record[strain] == "small" ? Strain::small : Strain::corotated;
    data.continued = record[inversion.inversion] == "clamped";
    data.tangent = !record.has(tangent)           ? TangentKind::automatic
                   : record[tangent] == "rotated" ? TangentKind::rotated
                                                  : TangentKind::exact;
    return make_linear_elastic(data);
  });
  return material;
}

}  // namespace msml::fe
