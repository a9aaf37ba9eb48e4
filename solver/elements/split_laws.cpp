// SPDX-License-Identifier: GPL-3.0-or-later
// Takes laws apart, and refuses what cannot be.
#include "solver/elements/split_laws.hpp"

#include <fmt/format.h>

#include <cmath>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

bool splits(Formulation formulation) { return formulation == Formulation::fbar || formulation == Formulation::mixed; }

const char* spelled(Formulation formulation) { return formulation == Formulation::fbar ? "fbar" : "mixed"; }

void check_cells(const Model& model) {
  const bool mixed = model.formulation == Formulation::mixed;
  const CellKind wanted = mixed ? CellKind::tet10 : CellKind::tet4;
  for (const Region& region : model.regions)
    for (const int e : region.elements)
      if (model.mesh->kinds[static_cast<std::size_t>(e)] != wanted)
        throw Error(fmt::format("formulation=\"{}\" is for {}; the body has {} cells", spelled(model.formulation),
                                mixed ? "quadraticTet (quadratic displacement, linear pressure)"
                                      : "linearTet (volume changes averaged over patches)",
                                name(model.mesh->kinds[static_cast<std::size_t>(e)])));
}

}  // namespace

void check_law(const Model& model, const Region& region) {
  const std::optional<Split> split = region.law->split();
  const bool incompressible = split && !std::isfinite(split->modulus);
  if (incompressible && model.formulation != Formulation::mixed)
    throw Error(fmt::format(
        "region '{}': {} is incompressible, which needs quadraticTet with formulation=\"mixed\"; or choose a "
        "poissonRatio below 0.5, a finite bulkModulus",
        region.name, region.law->name()));
  if (model.formulation == Formulation::single_rotation &&
      (region.law->name() != "linearElasticMaterial" || region.law->small_strain()))
    throw Error(
        fmt::format("region '{}': formulation = singleRotation is for linearElasticMaterial with strain = corotated; "
                    "its law is {}{}",
                    region.name, region.law->name(), region.law->small_strain() ? " of small strain" : ""));
  if (!splits(model.formulation)) return;
  const char* formulation = spelled(model.formulation);
  if (!split)
    throw Error(
        fmt::format("region '{}': {} has no volumetric part of its own, which formulation=\"{}\" needs; choose "
                    "formulation=\"standard\" or another material",
                    region.name, region.law->name(), formulation));
  if (!(split->modulus > 0))
    throw Error(
        fmt::format("region '{}': the volumetric modulus of {} is {:g}, not > 0 as formulation=\"{}\" needs; choose "
                    "formulation=\"standard\" or a poissonRatio > 0",
                    region.name, region.law->name(), split->modulus, formulation));
  if (region.point_law)
    throw Error(
        fmt::format("region '{}': parameters that vary inside elements do not go with formulation=\"{}\"; choose "
                    "formulation=\"standard\"",
                    region.name, formulation));
  if (!region.prony.g.empty())
    throw Error(fmt::format("region '{}': prony does not go with formulation=\"{}\"; choose formulation=\"standard\"",
                            region.name, formulation));
}

BatchSplit split_of(const Region& region, std::span<const int> elements) {
  const Split split = (region.local_law ? region.local_law(elements) : region.law)->split().value();
  BatchSplit batch{split.rest, split.constraint, lanes_of(split.modulus), {}};
  if (region.local_law)
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t e = std::min(static_cast<std::size_t>(lane), elements.size() - 1);
      batch.modulus[lane] = region.local_law(elements.subspan(e, 1))->split().value().modulus;
    }
  batch.compliance = 1 / batch.modulus;
  return batch;
}

void check_formulation(const Model& model) {
  for (const Region& region : model.regions)
    if (!region.elements.empty() && region.law) check_law(model, region);
  if (!splits(model.formulation)) return;
  check_cells(model);
  if (model.formulation == Formulation::mixed && is_explicit(model.settings.integrator))
    throw Error(
        fmt::format("timeIntegration=\"{}\" is explicit, but the pressure of formulation=\"mixed\" has to be solved "
                    "for; choose an implicit one, or formulation=\"fbar\" with linearTet",
                    name(model.settings.integrator)));
  if (model.formulation == Formulation::mixed && model.settings.linear_solver == LinearSolver::cg)
    throw Error(
        "linearSolver=\"CG\" needs a positive definite matrix, which formulation=\"mixed\" does not give; choose "
        "linearSolver=\"direct\"");
}

}  // namespace msml::fe
