// SPDX-License-Identifier: GPL-3.0-or-later
// Elastic constants and the attributes of volume changes.
#include "solver/materials/hyperelastic.hpp"

#include <fmt/format.h>

#include "msml/core/error.hpp"

namespace msml::fe {

Lame lame_of(double youngs_modulus, double poisson_ratio) {
  return {youngs_modulus / (2 * (1 + poisson_ratio)),
          youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))};
}

double poisson_ratio_of(double bulk, double shear) { return (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear); }

VolumeKeys describe_volume(Description& material) {
  VolumeKeys keys;
  keys.volumetric = material.parameter<std::string>(
      "volumetric",
      {.fallback = "lnJ2",
       .choices = {"lnJ2", "J1", "I3"},
       .doc = "energy of volume changes J = det F with bulk modulus kappa at rest: lnJ2 = kappa/2 (ln J)^2; "
              "J1 = kappa/2 (J - 1)^2; I3 = p (I3 - 1)^2 with I3 = J^2 and p = kappa/8"});
  keys.bulk_modulus = material.parameter(
      "bulkModulus",
      {.unit = "stress", .range = positive(), .optional = true, .doc = "kappa; needed unless incompressible"});
  keys.incompressible = material.parameter<bool>(
      "incompressible", {.fallback = false, .doc = "no volume change at all; needs a mesh with formulation=\"mixed\""});
  return keys;
}

Volumetric<Lanes> make_volumetric(const std::string& name, double bulk_modulus) {
  if (name == "J1") return {VolumeMeasure::change, lanes_of(bulk_modulus)};
  if (name == "I3") return {VolumeMeasure::square, lanes_of(bulk_modulus / 4)};
  return {VolumeMeasure::logarithm, lanes_of(bulk_modulus)};
}

void check_volume(const Record& record, const VolumeKeys& keys, Faults& faults) {
  const bool incompressible = record[keys.incompressible], given = record.has(keys.bulk_modulus);
  if (incompressible && given)
    faults.add(fmt::format("{}: incompressible = \"true\" leaves no room for bulkModulus. Leave one of them out",
                           record.tag()));
  if (!incompressible && !given)
    faults.add(
        fmt::format("{} needs bulkModulus, or incompressible = \"true\" with formulation = \"mixed\"", record.tag()));
}

VolumeChoice volume_choice(const Record& record, const VolumeKeys& keys, double shear_modulus) {
  Faults faults(record);
  check_volume(record, keys, faults);
  faults.raise();
  if (record[keys.incompressible])
    return {.energy = make_volumetric(record[keys.volumetric], 0), .poisson_ratio = 0.5, .incompressible = true};
  const double bulk = record[keys.bulk_modulus];
  return {.energy = make_volumetric(record[keys.volumetric], bulk),
          .poisson_ratio = poisson_ratio_of(bulk, shear_modulus)};
}

}  // namespace msml::fe
