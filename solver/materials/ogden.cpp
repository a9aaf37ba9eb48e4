// SPDX-License-Identifier: GPL-3.0-or-later
// The tag ogdenMaterial.
#include "solver/materials/ogden.hpp"

#include <fmt/format.h>

#include <utility>

#include "msml/core/error.hpp"
#include "solver/materials/clamped.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/registry.hpp"

namespace msml::fe {
namespace {

class OgdenLaw final : public Law, public StretchLaw {
 public:
  OgdenLaw(Ogden<Lanes> kernel, Volumetric<Lanes> volumetric, LawFacts facts)
      : kernel_(std::move(kernel)), volumetric_(volumetric), facts_(std::move(facts)) {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const Invariants<Lanes> invariants(gradients[i]);
      const Stretches<Lanes> s = stretches_of(invariants.F());
      respond(kernel_(s.value, invariants.j, volumetric_), s, want != Want::stress, responses[i]);
      if (want == Want::definite_tangent) make_semidefinite(responses[i]);
    }
  }
  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Response response;
      evaluate(Want::stress, gradients.subspan(i, 1), {&response, 1});
      measure_hyperelastic(gradients[i], response, measures[i]);
    }
  }
  std::string name() const override { return facts_.name; }
  double poisson_ratio() const override { return facts_.poisson_ratio; }
  double shear_modulus() const override { return facts_.shear_modulus; }
  bool incompressible() const override { return facts_.incompressible; }

  Jet<Nilpotent, 3> of_stretches(const Nilpotent (&s)[3], int lane) const override {
    const auto at = [lane](const Lanes& x) { return Nilpotent(x[lane]); };
    const Volumetric<Nilpotent> volumetric{volumetric_.measure, at(volumetric_.modulus)};
    return kernel_.map<Nilpotent>(at)(s, s[0] * s[1] * s[2] - 1.0, volumetric).w;
  }
  std::optional<Split> split() const override {
    if (volumetric_.measure == VolumeMeasure::none) return std::nullopt;
    LawFacts facts = facts_;
    facts.incompressible = false;
    Split split{.rest = std::make_shared<OgdenLaw>(kernel_, Volumetric<Lanes>{}, facts),
                .constraint = make_volume_constraint(volumetric_.measure)};
    if (!facts_.incompressible) split.modulus = volumetric_.modulus;
    return split;
  }
  std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> others) const override {
    OgdenLaw result = *this;
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const auto* other = dynamic_cast<const OgdenLaw*>(others[lane].get());
      if (other == nullptr || other->volumetric_.measure != volumetric_.measure ||
          other->kernel_.mu.size() != kernel_.mu.size())
        return {};
      result.volumetric_.modulus[lane] = other->volumetric_.modulus[lane];
      for (std::size_t p = 0; p < kernel_.mu.size(); ++p) {
        result.kernel_.mu[p][lane] = other->kernel_.mu[p][lane];
        result.kernel_.alpha[p][lane] = other->kernel_.alpha[p][lane];
      }
    }
    return std::make_shared<OgdenLaw>(std::move(result));
  }

 private:
  Ogden<Lanes> kernel_;
  Volumetric<Lanes> volumetric_;
  LawFacts facts_;
};

void check_terms(const Record& record, const std::vector<double>& mu, const std::vector<double>& alpha,
                 Faults& faults) {
  if (mu.empty() || mu.size() != alpha.size() || mu.size() > 10)
    return faults.add(fmt::format("{}: mu has {} numbers and alpha has {}; both take the same count, 1 to 10",
                                  record.tag(), mu.size(), alpha.size()));
  for (std::size_t p = 0; p < mu.size(); ++p)
    if (!(mu[p] * alpha[p] > 0))
      faults.add(fmt::format("{}: mu = {:g} with alpha = {:g}: the product of each pair must be > 0", record.tag(),
                             mu[p], alpha[p]));
}

}  // namespace

MaterialFactory ogden_material() {
  MaterialFactory material("ogdenMaterial", "material",
                           "Ogden's rubber in the principal stretches s_i, W = sum of mu_p/alpha_p (x_1^alpha_p + "
                           "x_2^alpha_p + x_3^alpha_p - 3) + volumetric, x_i = J^(-1/3) s_i.");
  material.source("Ogden 1972, doi 10.1098/rspa.1972.0026");
  material.note(
      "At rest the shear modulus is sum of mu_p alpha_p / 2, the bulk modulus is bulkModulus. One term with alpha = 2 "
      "is "
      "the isochoric neo-Hookean law.");
  const auto mu = material.parameter<std::vector<double>>("mu", {.unit = "stress", .doc = "mu_1 mu_2 …, up to 10"});
  const auto alpha = material.parameter<std::vector<double>>(
      "alpha", {.doc = "alpha_1 alpha_2 …, as many; mu_p alpha_p is > 0 for each p"});
  const VolumeKeys keys = describe_volume(material);
  const InversionKeys inversion = describe_inversion(material);
  material.build([=](const Record& record) {
    Faults faults(record);
    check_terms(record, record[mu], record[alpha], faults);
    check_volume(record, keys, faults);
    check_inversion(record, inversion, record[keys.incompressible], faults);
    faults.raise();
    Ogden<Lanes> kernel;
    double shear = 0;
    for (std::size_t p = 0; p < record[mu].size(); ++p) {
      kernel.mu.push_back(lanes_of(record[mu][p]));
      kernel.alpha.push_back(lanes_of(record[alpha][p]));
      shear += 0.5 * record[mu][p] * record[alpha][p];
    }
    const VolumeChoice volume = volume_choice(record, keys, shear);
    const LawFacts facts{.name = record.tag(),
                         .shear_modulus = shear,
                         .poisson_ratio = volume.poisson_ratio,
                         .incompressible = volume.incompressible};
    return with_inversion(record, inversion, std::make_shared<OgdenLaw>(kernel, volume.energy, facts));
  });
  return material;
}

}  // namespace msml::fe
