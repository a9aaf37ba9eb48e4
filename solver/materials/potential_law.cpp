// SPDX-License-Identifier: GPL-3.0-or-later
// What all laws of invariants share.
#include "solver/materials/potential_law.hpp"

namespace msml::fe {
namespace {

/// g(J) itself.
class VolumeConstraint final : public Law {
 public:
  explicit VolumeConstraint(VolumeMeasure measure) : measure_(measure) {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const Invariants<Lanes> invariants(gradients[i]);
      const Function<Lanes> g = volume_measure(measure_, invariants.j);
      const Tensor<Lanes> slopes[1] = {invariants.slope_of_j()};
      Response& out = responses[i];
      out.energy = g.value;
      for (int k = 0; k < 9; ++k) out.P.c[k] = g.slope * slopes[0].c[k];
      if (want == Want::stress) continue;
      for (Lanes& entry : out.tangent) entry = Lanes{};
      add_products(Jet<Lanes, 1>::of_variable(0, g.value, g.slope, g.curvature), slopes, out.tangent);
      add_curvature_of_volume(g.slope, invariants.F(), out.tangent);
    }
  }
  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Response response;
      evaluate(Want::stress, gradients.subspan(i, 1), {&response, 1});
      measure_hyperelastic(gradients[i], response, measures[i]);
    }
  }
  std::string name() const override { return "volume"; }
  double poisson_ratio() const override { return 0; }
  double shear_modulus() const override { return 0; }
  bool survives_inversion() const override { return fe::survives_inversion(measure_); }

 private:
  VolumeMeasure measure_;
};

}  // namespace

std::shared_ptr<const Law> make_volume_constraint(VolumeMeasure measure) {
  return std::make_shared<VolumeConstraint>(measure);
}

void measure_hyperelastic(const Gradients& H, const Response& response, Measures& out) {
  const Tensor<Lanes> F = deformation_gradient(H);
  Lanes J = determinant(F);
  for (int i = 0; i < lanes; ++i)
    if (std::abs(J[i]) < 1e-12) J[i] = 1e-12;  // flat: the stress is past all measure, yet finite
  out.energy = response.energy;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      Lanes stress{}, square{};
      for (int m = 0; m < 3; ++m) {
        stress += response.P(i, m) * F(k, m);
        square += H(m, i) * H(m, k);
      }
      out.cauchy(i, k) = stress / J;
      out.strain(i, k) = 0.5 * (H(i, k) + H(k, i) + square);
    }
}

}  // namespace msml::fe
