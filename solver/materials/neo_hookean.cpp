// SPDX-License-Identifier: GPL-3.0-or-later
// The tag neoHookeanMaterial.
#include "solver/materials/neo_hookean.hpp"

#include <fmt/format.h>

#include "msml/core/error.hpp"
#include "solver/materials/clamped.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/registry.hpp"

namespace msml::fe {
namespace {

struct Keys {
  Key<double> young, poisson;
  Key<std::string> form, volumetric;
  Key<bool> incompressible;
};

Keys describe(Description& material) {
  Keys keys;
  keys.young = material.parameter("youngModulus", {.unit = "stress", .range = positive(), .doc = "Young's modulus E"});
  keys.poisson = material.parameter(
      "poissonRatio",
      {.range = open(-1, 0.5), .optional = true, .doc = "Poisson's ratio nu; needed unless incompressible"});
  keys.form = material.parameter<std::string>(
      "form",
      {.fallback = "log",
       .choices = {"log", "cubic", "stable", "isochoric"},
       .doc = "log: mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2, infinite at J = 0; cubic: the same with the "
              "cubic Taylor polynomial of ln J at 1, goes on through inversion; stable: Smith, de Goes and Kim, "
              "returns from any inversion; isochoric: mu/2 (J^(-2/3) I1 - 3) + volumetric"});
  keys.volumetric = material.parameter<std::string>(
      "volumetric", {.fallback = "lnJ2",
                     .choices = {"lnJ2", "J1", "I3"},
                     .doc = "isochoric only: kappa/2 (ln J)^2, kappa/2 (J - 1)^2 or kappa/8 (J^2 - 1)^2"});
  keys.incompressible = material.parameter<bool>(
      "incompressible",
      {.fallback = false, .doc = "no volume change, mu = E/3; needs a mesh with formulation=\"mixed\""});
  return keys;
}

void check(const Record& record, const Keys& keys, Faults& faults) {
  const bool incompressible = record[keys.incompressible];
  const std::string& form = record[keys.form];
  if (incompressible && record.has(keys.poisson))
    faults.add(fmt::format("{}: incompressible = \"true\" leaves no room for poissonRatio. Leave one of them out",
                           record.tag()));
  if (!incompressible && !record.has(keys.poisson))
    faults.add(
        fmt::format("{} needs poissonRatio, or incompressible = \"true\" with formulation = \"mixed\"", record.tag()));
  if (form != "isochoric" && record.is_given(keys.volumetric))
    faults.add(
        fmt::format("{}: volumetric = \"{}\" has no place in form = \"{}\", which has its own energy of volume "
                    "changes. Leave it out, or take form = \"isochoric\"",
                    record.tag(), record[keys.volumetric], form));
}

/// Lambda is 0 if incompressible.
Lame constants(const Record& record, const Keys& keys) {
  if (record[keys.incompressible]) return {record[keys.young] / 3, 0};
  return lame_of(record[keys.young], record[keys.poisson]);
}

template <template <class> class Kernel>
std::shared_ptr<const Law> make(Lame lame, VolumeMeasure measure, double modulus, LawFacts facts) {
  if (facts.incompressible) modulus = 0;
  facts.survives_inversion = facts.survives_inversion && survives_inversion(measure);
  return std::make_shared<PotentialLaw<Kernel>>(Kernel<Lanes>{lanes_of(lame.mu)},
                                                Volumetric<Lanes>{measure, lanes_of(modulus)}, facts);
}

std::shared_ptr<const Law> make_stable(Lame lame, LawFacts facts) {
  facts.survives_inversion = true;
  return make<StableNeoHookean>(lame, VolumeMeasure::change, lame.lambda + lame.mu * 5 / 6, facts);
}

std::shared_ptr<const Law> build(const Record& record, const Keys& keys) {
  const Lame lame = constants(record, keys);
  const std::string& form = record[keys.form];
  LawFacts facts{.name = record.tag(), .shear_modulus = lame.mu, .incompressible = record[keys.incompressible]};
  facts.poisson_ratio = facts.incompressible ? 0.5 : record[keys.poisson];
  if (form == "isochoric") {
    const auto U = make_volumetric(record[keys.volumetric], lame.bulk());
    return make<IsochoricNeoHookean>(lame, U.measure, U.modulus[0], facts);
  }
  if (form == "log") return make<LogNeoHookean>(lame, VolumeMeasure::logarithm, lame.lambda, facts);
  if (form == "stable") return make_stable(lame, facts);
  facts.survives_inversion = true;
  return make<CubicNeoHookean>(lame, VolumeMeasure::cubic, lame.lambda, facts);
}

}  // namespace

std::shared_ptr<const Law> make_stable_neo_hookean(double shear_modulus, double poisson_ratio) {
  return make_stable({shear_modulus, 2 * shear_modulus * poisson_ratio / (1 - 2 * poisson_ratio)},
                     {.name = "neoHookeanMaterial", .shear_modulus = shear_modulus, .poisson_ratio = poisson_ratio});
}

MaterialFactory neo_hookean_material() {
  MaterialFactory material("neoHookeanMaterial", "material",
                           "Neo-Hookean rubber: large strains and rotations, with one shear modulus.");
  material.source(
      "log: Bonet and Wood 1997, Nonlinear continuum mechanics for finite element analysis; stable: Smith, de Goes and "
      "Kim 2018, doi 10.1145/3180491, with its constants chosen for Hooke's law at rest; isochoric: Flory 1961, doi "
      "10.1039/tf9615700829");
  material.note(
      "mu = E/(2 (1 + nu)), lambda = E nu/((1 + nu)(1 - 2 nu)), kappa = lambda + 2/3 mu: for small strain every form "
      "is "
      "Hooke's law of E and nu.");
  const Keys keys = describe(material);
  const InversionKeys inversion = describe_inversion(material);
  material.build([=](const Record& record) {
    Faults faults(record);
    check(record, keys, faults);
    check_inversion(record, inversion, record[keys.incompressible], faults);
    faults.raise();
    return with_inversion(record, inversion, build(record, keys));
  });
  return material;
}

}  // namespace msml::fe
