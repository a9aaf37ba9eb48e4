// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses what does not go together.
#include "solver/combinations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "msml/core/error.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {
namespace {

bool splits(Formulation formulation) { return formulation == Formulation::fbar || formulation == Formulation::mixed; }

const char* spelled(Formulation formulation) {
  switch (formulation) {
    case Formulation::single_rotation:
      return "singleRotation";
    case Formulation::fbar:
      return "fbar";
    case Formulation::mixed:
      return "mixed";
    default:
      return "standard";
  }
}

void check_integrator(const Settings& s) {
  check_number("beta", s.newmark_beta, false);
  check_number("gamma", s.newmark_gamma, true);
  if (!(s.step_tolerance > 0 && s.step_tolerance < 1))
    throw Error(fmt::format("stepTolerance = {} is not in (0, 1)", s.step_tolerance));
  if (s.arc_length.on && s.integrator != Integrator::static_)
    throw Error(fmt::format("arcLength follows static equilibria, but timeIntegration is {}: choose static",
                            name(s.integrator)));
  check_number("arcSteps", s.arc_length.steps, false);
  if (s.adaptive_step && is_explicit(s.integrator))
    throw Error(
        fmt::format("adaptiveStep = true does not go with the explicit timeIntegration = {}, whose dt is that "
                    "of the step: leave adaptiveStep out, or choose an implicit timeIntegration",
                    name(s.integrator)));
  if (s.adaptive_step && s.arc_length.on)
    throw Error("adaptiveStep = true does not go with arcLength, which adapts its own steps: leave adaptiveStep out");
  if (!(s.spectral_radius >= 0 && s.spectral_radius <= 1))
    throw Error(fmt::format("spectralRadius = {} is not in [0, 1]", s.spectral_radius));
  if (s.integrator != Integrator::newmark || s.allow_unstable) return;
  if (s.newmark_gamma < 0.5 || 2 * s.newmark_beta < s.newmark_gamma)
    throw Error(
        fmt::format("Newmark with beta = {}, gamma = {} grows without bound at some time steps: take gamma >= 1/2 and "
                    "beta >= gamma/2, or allowUnstable = true",
                    s.newmark_beta, s.newmark_gamma));
}

void check_cells(Formulation formulation, CellKind kind) {
  if (formulation == Formulation::single_rotation && kind != CellKind::tet10)
    throw Error(fmt::format("formulation = singleRotation is for quadraticTet, the elements are {}", name(kind)));
  if (formulation == Formulation::mixed && kind != CellKind::tet10)
    throw Error(
        fmt::format("formulation=\"mixed\" is for quadraticTet (quadratic displacement, linear pressure); the body has "
                    "{} cells",
                    name(kind)));
  if (formulation == Formulation::fbar && kind != CellKind::tet4)
    throw Error(
        fmt::format("formulation=\"fbar\" is for linearTet (volume changes averaged over patches); the body has {} "
                    "cells",
                    name(kind)));
}

void check_split(const Model& model, const Region& region, const std::optional<Split>& split) {
  const char* formulation = spelled(model.formulation);
  if (!split)
    throw Error(
        fmt::format("region '{}': {} has no volumetric part of its own, which formulation=\"{}\" needs; choose "
                    "formulation=\"standard\" or another material",
                    region.name, region.law->name(), formulation));
  if (!(split->modulus[0] > 0))
    throw Error(
        fmt::format("region '{}': the volumetric modulus of {} is {:g}, not > 0 as formulation=\"{}\" needs; choose "
                    "formulation=\"standard\" or a poissonRatio > 0",
                    region.name, region.law->name(), split->modulus[0], formulation));
}

const char* unknown_of(const Law& law) { return law.components() == 1 ? "a scalar unknown" : "displacements"; }

/// The laws of one body have one kind of unknown. Returns whether it is a scalar one.
bool check_unknowns(const Model& model) {
  const Region* first = nullptr;
  for (const Region& region : model.regions) {
    if (!region.law) continue;
    if (!first) first = &region;
    if ((region.law->components() == 1) != (first->law->components() == 1))
      throw Error(
          fmt::format("region '{}' has a law of {} ({}), but region '{}' one of {} ({}): one kind of problem at a time",
                      region.name, unknown_of(*region.law), region.law->name(), first->name, unknown_of(*first->law),
                      first->law->name()));
  }
  return first && first->law->components() == 1;
}

}  // namespace

void check_number(const char* what, double value, bool zero_allowed) {
  if (!std::isfinite(value) || value < 0 || (!zero_allowed && value == 0))
    throw Error(fmt::format("{} = {} is not {}", what, value, zero_allowed ? ">= 0" : "> 0"));
}

void check_settings(const Settings& s) {
  check_number("dampingRayleighRatioMass", s.damping_mass, true);
  check_number("dampingRayleighRatioStiffness", s.damping_stiffness, true);
  check_number("tolerance", s.tolerance, false);
  check_number("linearTolerance", s.linear_tolerance, false);
  if (s.tolerance >= 1) throw Error(fmt::format("tolerance = {} is not in (0, 1)", s.tolerance));
  if (s.linear_tolerance >= 1) throw Error(fmt::format("linearTolerance = {} is not in (0, 1)", s.linear_tolerance));
  check_number("newtonIterations", s.newton_iterations, false);
  check_number("loadSteps", s.load_steps, false);
  check_number("threads", s.threads, false);
  check_integrator(s);
}

void check_elements(const Model& model, CellKind kind) {
  check_cells(model.formulation, kind);
  if (model.quadrature != 4 && (model.quadrature != 8 || kind != CellKind::tet10))
    throw Error(fmt::format("quadrature = {} is not 4, or 8 for quadraticTet", model.quadrature));
  if (model.quadrature != 4 && model.formulation != Formulation::standard)
    throw Error(
        fmt::format("quadrature = {} needs formulation = standard, but it is {}: take quadrature = 4 or leave it out",
                    model.quadrature, spelled(model.formulation)));
  check_number("thickness", model.thickness, false);
  if (model.plane == Plane::stress && dimension(kind) != 2)
    throw Error(fmt::format("plane = stress is for triangles, the elements are {}", name(kind)));
}

void check_law(const Model& model, const Region& region) {
  if (!region.law) return;
  const std::optional<Split> split = region.law->split();
  const bool incompressible = region.law->incompressible() || (split && !std::isfinite(split->modulus[0]));
  if (incompressible && model.formulation != Formulation::mixed)
    throw Error(
        fmt::format("region '{}': {} is incompressible, which needs a mesh with formulation=\"mixed\" (quadraticTet); "
                    "or choose a poissonRatio below 0.5, a finite bulkModulus",
                    region.name, region.law->name()));
  if (model.formulation == Formulation::single_rotation &&
      (region.law->name() != "linearElasticMaterial" || region.law->small_strain()))
    throw Error(
        fmt::format("region '{}': formulation = singleRotation is for linearElasticMaterial with strain = corotated; "
                    "its law is {}{}",
                    region.name, region.law->name(), region.law->small_strain() ? " of small strain" : ""));
  if (model.plane == Plane::stress && region.law->components() == 1)
    throw Error(
        fmt::format("region '{}': plane=\"stress\" is about displacements, which {} does not have; leave plane "
                    "out",
                    region.name, region.law->name()));
  if (splits(model.formulation)) check_split(model, region, split);
}

void check_prony(const Model& model, const Region& region) {
  const Prony& prony = region.prony;
  if (prony.g.size() != prony.tau.size())
    throw Error(fmt::format("region '{}': prony has {} values of g and {} of tau: one of each per term", region.name,
                            prony.g.size(), prony.tau.size()));
  if (prony.g.empty()) return;
  double sum = 0;
  for (std::size_t i = 0; i < prony.g.size(); ++i) {
    sum += prony.g[i];
    if (!std::isfinite(prony.g[i]) || prony.g[i] <= 0)
      throw Error(fmt::format("region '{}': prony: g = {} is not > 0", region.name, prony.g[i]));
    if (!std::isfinite(prony.tau[i]) || prony.tau[i] <= 0)
      throw Error(fmt::format("region '{}': prony: tau = {} is not > 0", region.name, prony.tau[i]));
  }
  if (sum >= 1) throw Error(fmt::format("region '{}': prony: the sum of g = {} is not < 1", region.name, sum));
  if (region.law && region.law->components() == 1)
    throw Error(fmt::format("region '{}': prony is for stresses, which {} does not have; leave prony out", region.name,
                            region.law->name()));
  if (model.settings.arc_length.on)
    throw Error(
        fmt::format("region '{}': prony needs time, but arcLength follows equilibria along the load; leave "
                    "out prony or arcLength",
                    region.name));
}

void check_problem(const Model& model) {
  const Settings& settings = model.settings;
  if (check_unknowns(model) && is_dynamic(settings.integrator))
    throw Error(
        fmt::format("a scalar problem (diffusionMaterial) is stationary, but timeIntegration is {}: choose "
                    "timeIntegration=\"static\" or \"quasiStatic\"",
                    name(settings.integrator)));
  if (model.formulation != Formulation::mixed) return;
  if (is_explicit(settings.integrator))
    throw Error(
        fmt::format("timeIntegration=\"{}\" is explicit, but the pressure of formulation=\"mixed\" has to be solved "
                    "for; choose an implicit one, or formulation=\"fbar\" with linearTet",
                    name(settings.integrator)));
  if (settings.linear_solver == LinearSolver::cg)
    throw Error(
        "linearSolver=\"CG\" (and \"GMRES\", which is taken as it) needs a positive definite matrix, which "
        "formulation=\"mixed\" does not give; choose linearSolver=\"direct\"");
}

}  // namespace msml::fe
