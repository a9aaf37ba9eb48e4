// SPDX-License-Identifier: GPL-3.0-or-later
// The tag stVenantKirchhoffMaterial.
#include "solver/materials/saint_venant_kirchhoff.hpp"

#include "solver/materials/clamped.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/registry.hpp"

namespace msml::fe {

MaterialFactory saint_venant_kirchhoff_material() {
  MaterialFactory material("stVenantKirchhoffMaterial", "material",
                           "Hooke's law between the Green-Lagrange strain E and the second Piola stress: large "
                           "rotations, moderate strains.");
  material.source("W = lambda/2 (tr E)^2 + mu E:E; Ciarlet 1988, Mathematical elasticity I");
  material.note(
      "Softens in compression: in a bar the stress turns back where it is pressed to 1/sqrt(3) of its length, and "
      "elements may invert. Prefer neoHookeanMaterial there.");
  const auto young =
      material.parameter("youngModulus", {.unit = "stress", .range = positive(), .doc = "Young's modulus"});
  const auto poisson = material.parameter("poissonRatio", {.range = open(-1, 0.5), .doc = "Poisson's ratio"});
  const InversionKeys inversion = describe_inversion(material);
  material.build([=](const Record& record) -> std::shared_ptr<const Law> {
    const Lame lame = lame_of(record[young], record[poisson]);
    const LawFacts facts{
        .name = record.tag(), .shear_modulus = lame.mu, .poisson_ratio = record[poisson], .survives_inversion = true};
    const SaintVenantKirchhoff<Lanes> kernel{lanes_of(lame.mu), lanes_of(lame.lambda)};
    return with_inversion(record, inversion,
                          std::make_shared<PotentialLaw<SaintVenantKirchhoff>>(kernel, Volumetric<Lanes>{}, facts));
  });
  return material;
}

}  // namespace msml::fe
