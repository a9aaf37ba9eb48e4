// SPDX-License-Identifier: GPL-3.0-or-later
// The continuation of an energy below a stretch.
#include "solver/materials/clamped.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "msml/core/error.hpp"
#include "msml/core/mesh.hpp"
#include "solver/materials/nilpotent.hpp"
#include "solver/materials/potential_law.hpp"
#include "solver/materials/stretches.hpp"

namespace msml::fe {
namespace {

/// Singular values, the smallest with the sign of det F, in descending order.
Stretches<double> signed_stretches(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  Vec3 s = svd.singularValues();
  if (U.determinant() * svd.matrixV().determinant() < 0) {
    U.col(2) = -U.col(2);
    s[2] = -s[2];
  }
  Stretches<double> result;
  for (int i = 0; i < 3; ++i) {
    result.value[i] = s[i];
    for (int k = 0; k < 3; ++k) {
      result.U(i, k) = U(i, k);
      result.V(i, k) = svd.matrixV()(i, k);
    }
  }
  return result;
}

/// The continued energy at s. `stiffness` = 2 k.
Jet<double, 3> continued(const StretchLaw& law, int lane, const double (&s)[3], double c, double stiffness) {
  Nilpotent x[3];
  std::array<double, 3> below{};  // s_i - c where clamped, else 0
  bool clamped[3];
  for (std::size_t i = 0; i < 3; ++i) {
    clamped[i] = s[i] < c;
    x[i] = clamped[i] ? c : s[i];
    if (!clamped[i]) continue;
    below[i] = s[i] - c;
    x[i].c[1U << i] = 1;
  }
  const Jet<Nilpotent, 3> w = law.of_stretches(x, lane);
  Jet<double, 3> out;
  out.value = w.value.at(below);
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> without = below;
    without[i] = 0;
    const int a = static_cast<int>(i);
    out.value += 0.5 * stiffness * below[i] * below[i];
    out.first[i] = w.first[i].at(without) + stiffness * below[i];
    out.second[w.at(a, a)] = clamped[i] ? stiffness : w.second[w.at(a, a)].at(below);
    for (std::size_t k = 0; k < i; ++k) {
      std::array<double, 3> neither = without;
      neither[k] = 0;
      const int b = static_cast<int>(k);
      out.second[w.at(a, b)] = w.second[w.at(a, b)].at(neither);
    }
  }
  return out;
}

StretchEnergy<double> with_quotients(const Jet<double, 3>& w, const double (&s)[3]) {
  StretchEnergy<double> out{.w = w, .difference = {}, .sum = {}};
  for (int pair = 0; pair < 3; ++pair) {
    const int i = pair == 0 ? 1 : 2, j = pair == 2 ? 1 : 0;
    const double d = s[i] - s[j], sum = s[i] + s[j], size = std::abs(s[i]) + std::abs(s[j]) + 1e-3;
    // Nearer than 3e-6 the quotient has fewer correct digits than its limit, whose error is of second order.
    out.difference[pair] = std::abs(d) > 3e-6 * size
                               ? (w.first[i] - w.first[j]) / d
                               : 0.5 * (w.second[w.at(i, i)] + w.second[w.at(j, j)]) - w.second[w.at(i, j)];
    // At opposite stretches the rotation is not unique; a bounded tangent has to do.
    out.sum[pair] = (w.first[i] + w.first[j]) / std::copysign(std::max(std::abs(sum), 1e-4), sum);
  }
  return out;
}

class ClampedLaw final : public Law {
 public:
  ClampedLaw(std::shared_ptr<const Law> law, Lanes c, Lanes stiffness)
      : law_(std::move(law)), stretch_law_(dynamic_cast<const StretchLaw*>(law_.get())), c_(c), stiffness_(stiffness) {
    assert(stretch_law_ != nullptr && law_->isotropic());
  }

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    law_->evaluate(want, gradients, responses);
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const bool changed = replace(gradients[i], want != Want::stress, responses[i]);
      if (changed && want == Want::definite_tangent) make_semidefinite(responses[i]);
    }
  }
  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Response response;
      evaluate(Want::stress, gradients.subspan(i, 1), {&response, 1});
      measure_hyperelastic(gradients[i], response, measures[i]);
    }
  }
  std::string name() const override { return law_->name(); }
  double poisson_ratio() const override { return law_->poisson_ratio(); }
  double shear_modulus() const override { return law_->shear_modulus(); }
  bool survives_inversion() const override { return true; }
  std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> others) const override {
    std::vector<std::shared_ptr<const Law>> inner;
    Lanes c = c_, stiffness = stiffness_;
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const auto* other = dynamic_cast<const ClampedLaw*>(others[lane].get());
      if (other == nullptr) return {};
      inner.push_back(other->law_);
      c[lane] = other->c_[lane];
      stiffness[lane] = other->stiffness_[lane];
    }
    auto law = law_->merged(inner);
    return law ? std::make_shared<ClampedLaw>(std::move(law), c, stiffness) : nullptr;
  }

 private:
  /// Recomputes the lanes that have a stretch below c; true if there are any.
  bool replace(const Gradients& H, bool tangent, Response& out) const {
    const Tensor<Lanes> F = deformation_gradient(H);
    const Lanes J = determinant(F), bound = 0.5 * c_ * square_sum(F);
    bool any = false;
    for (int lane = 0; lane < lanes; ++lane) {
      if (J[lane] > bound[lane]) continue;  // s3 >= J/(s1 s2) and s1 s2 <= |F|^2/2
      Mat3 f;
      for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = F.c[k][lane];
      if (!f.allFinite()) continue;
      const Stretches<double> s = signed_stretches(f);
      if (s.value[2] >= c_[lane]) continue;
      any = true;
      ResponseOf<double> one;
      respond(with_quotients(continued(*stretch_law_, lane, s.value, c_[lane], stiffness_[lane]), s.value), s, tangent,
              one);
      out.energy[lane] = one.energy;
      for (int k = 0; k < 9; ++k) out.P.c[k][lane] = one.P.c[k];
      for (int k = 0; k < 45 && tangent; ++k) out.tangent[k][lane] = one.tangent[k];
    }
    return any;
  }

  std::shared_ptr<const Law> law_;
  const StretchLaw* stretch_law_;
  Lanes c_, stiffness_;
};

}  // namespace

std::array<Jet<Nilpotent, 3>, 3> invariants_of_stretches(const Nilpotent (&s)[3]) {
  using Number = Jet<Nilpotent, 3>;
  const Number x = Number::variable(0, s[0]), y = Number::variable(1, s[1]), z = Number::variable(2, s[2]);
  const Number xy = x * y, yz = y * z, zx = z * x;
  Number j = xy * z;
  j.value -= 1.0;
  Number a = x * x + y * y + z * z, b = xy * xy + yz * yz + zx * zx;
  a.value -= 3.0;
  b.value -= 3.0;
  return {a + scale<Nilpotent>(-2.0, j), j, b + scale<Nilpotent>(-4.0, j)};
}

std::shared_ptr<const Law> make_clamped(std::shared_ptr<const Law> law, double c) {
  if (!open(0, 1).contains(c)) throw Error(fmt::format("clampedBelow = {} is not in (0, 1)", c));
  const double nu = law->poisson_ratio(), stiffness = 2 * law->shear_modulus() * (1 - nu) / (1 - 2 * nu);
  return std::make_shared<ClampedLaw>(std::move(law), lanes_of(c), lanes_of(stiffness));
}

InversionKeys describe_inversion(Description& material) {
  InversionKeys keys;
  keys.inversion = material.parameter<std::string>(
      "inversion",
      {.fallback = "natural",
       .choices = {"natural", "clamped"},
       .doc = "natural: the law as it is; clamped: continued below the stretch clampedBelow by its tangent "
              "and a quadratic term, so that it returns from inversion (Stomakhin, Howes, Schroeder and "
              "Teran 2012, doi 10.2312/SCA/SCA12/025-032)"});
  keys.below = material.parameter(
      "clampedBelow", {.range = open(0, 1), .fallback = 0.3, .doc = "principal stretch; used if inversion is clamped"});
  return keys;
}

void check_inversion(const Record& record, const InversionKeys& keys, bool incompressible, Faults& faults) {
  if (incompressible && record[keys.inversion] == "clamped")
    faults.add(
        fmt::format("{}: inversion = \"clamped\" and incompressible = \"true\" exclude each other. Leave one of "
                    "them out",
                    record.tag()));
}

std::shared_ptr<const Law> with_inversion(const Record& record, const InversionKeys& keys,
                                          std::shared_ptr<const Law> law) {
  if (record[keys.inversion] == "natural") return law;
  Faults faults(record);
  check_inversion(record, keys, law->incompressible(), faults);
  faults.raise();
  return make_clamped(std::move(law), record[keys.below]);
}

}  // namespace msml::fe
