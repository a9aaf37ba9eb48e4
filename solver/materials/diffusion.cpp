// SPDX-License-Identifier: GPL-3.0-or-later
// The quadratic energy of a scalar field's gradient.
#include "solver/materials/diffusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

class Diffusion final : public Law {
 public:
  explicit Diffusion(const Lanes& coefficients) : c_(coefficients) {
    for (int lane = 0; lane < lanes; ++lane) {
      const double c = c_[lane];
      if (!(c > 0) || !std::isfinite(c)) throw Error(fmt::format("diffusionMaterial: coefficient = {} is not > 0", c));
    }
  }

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const Gradients& H = gradients[i];
      Response& out = responses[i];
      out.energy = 0.5 * c_ * square(H);
      out.P = {};
      for (int k = 0; k < 3; ++k) out.P(0, k) = c_ * H(0, k);
      if (want == Want::stress) continue;
      for (Lanes& entry : out.tangent) entry = Lanes{};
      for (int I = 0; I < 3; ++I) out.tangent[I * (I + 1) / 2 + I] = c_;
    }
  }

  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      measures[i] = Measures{};
      measures[i].energy = 0.5 * c_ * square(gradients[i]);
      for (int k = 0; k < 3; ++k) {
        measures[i].strain(0, k) = measures[i].strain(k, 0) = gradients[i](0, k);
        measures[i].cauchy(0, k) = measures[i].cauchy(k, 0) = c_ * gradients[i](0, k);
      }
    }
  }

  std::string name() const override { return "diffusionMaterial"; }
  double poisson_ratio() const override { return 0; }
  double shear_modulus() const override { return c_[0]; }
  bool survives_inversion() const override { return true; }
  int components() const override { return 1; }
  bool small_strain() const override { return true; }
  std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> others) const override {
    Lanes mixed = c_;
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const auto* other = dynamic_cast<const Diffusion*>(others[lane].get());
      if (other == nullptr) return {};
      mixed[lane] = other->c_[lane];
    }
    return std::make_shared<const Diffusion>(mixed);
  }

 private:
  static Lanes square(const Gradients& H) { return H(0, 0) * H(0, 0) + H(0, 1) * H(0, 1) + H(0, 2) * H(0, 2); }
  Lanes c_;
};

}  // namespace

std::shared_ptr<const Law> make_diffusion(const Lanes& coefficients) {
  return std::make_shared<const Diffusion>(coefficients);
}

std::shared_ptr<const Law> make_diffusion(double coefficient) { return make_diffusion(lanes_of(coefficient)); }

Factory<std::shared_ptr<const Law>> diffusion_material() {
  Factory<std::shared_ptr<const Law>> tag("diffusionMaterial", "material",
                                          "A scalar problem, such as heat conduction: -div(c grad u) = source.");
  const auto coefficient = tag.parameter("coefficient", {.range = positive(), .doc = "c, per unit of the gradient"});
  tag.note(
      "Its conditions are fixedValue, source and flux. The results carry u as the field value, in the place of "
      "displacement; stress and strain hold flux and gradient as their xx, xy and xz.");
  tag.build([=](const Record& record) { return make_diffusion(record[coefficient]); });
  return tag;
}

}  // namespace msml::fe
