// SPDX-License-Identifier: GPL-3.0-or-later
// What the tags of hyperelastic laws have in common: elastic constants and the energy of volume changes.
#pragma once
#include <optional>
#include <string>

#include "msml/core/faults.hpp"
#include "solver/materials/potential_law.hpp"

namespace msml::fe {

/// Lame's constants, stress.
struct Lame {
  double mu = 0, lambda = 0;
  double bulk() const { return lambda + 2 * mu / 3; }
};
Lame lame_of(double youngs_modulus, double poisson_ratio);

/// Poisson's ratio from bulk and shear modulus.
double poisson_ratio_of(double bulk, double shear);

/// The attributes `volumetric`, `bulkModulus` and `incompressible` of a law that leaves volume changes to them.
struct VolumeKeys {
  Key<std::string> volumetric;
  Key<double> bulk_modulus;
  Key<bool> incompressible;
};
VolumeKeys describe_volume(Description& material);

/// Adds a fault unless exactly one of bulkModulus and incompressible="true" is given.
void check_volume(const Record& record, const VolumeKeys& keys, Faults& faults);

/// The volumetric energy with that bulk modulus at rest (lnJ2: kappa/2 (ln J)^2; J1: kappa/2 (J - 1)^2; I3:
/// kappa/8 (I3 - 1)^2).
Volumetric<Lanes> make_volumetric(const std::string& name, double bulk_modulus);

/// What a scene says of volume changes.
struct VolumeChoice {
  Volumetric<Lanes> energy;
  double poisson_ratio = 0.5;
  bool incompressible = false;
};
/// Throws Error unless exactly one of bulkModulus and incompressible="true" is given, and on kappa below 2/3 mu too far
/// for Poisson's ratio to be above -1 (which no positive kappa is).
VolumeChoice volume_choice(const Record& record, const VolumeKeys& keys, double shear_modulus);

/// The law of a kernel that leaves volume changes to the attributes `keys`.
template <template <class> class Kernel>
std::shared_ptr<const Law> make_isochoric(const Record& record, const VolumeKeys& keys, Kernel<Lanes> kernel,
                                          double shear_modulus, bool isotropic = true) {
  const VolumeChoice volume = volume_choice(record, keys, shear_modulus);
  return std::make_shared<PotentialLaw<Kernel>>(std::move(kernel), volume.energy,
                                                LawFacts{.name = record.tag(),
                                                         .shear_modulus = shear_modulus,
                                                         .poisson_ratio = volume.poisson_ratio,
                                                         .isotropic = isotropic,
                                                         .incompressible = volume.incompressible});
}

}  // namespace msml::fe
