// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses what does not go together.
#include "solver/combinations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "msml/core/error.hpp"
#include "solver/materials/law.hpp"
#include "solver/materials/plane_stress.hpp"

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

void tell_of_number(const char* what, double value, bool zero_allowed, const Tell& tell) {
  if (!std::isfinite(value) || value < 0 || (!zero_allowed && value == 0))
    tell(Error(fmt::format("{} = {} is not {}", what, value, zero_allowed ? ">= 0" : "> 0")));
}

void check_integrator(const Settings& s, const Tell& tell) {
  tell_of_number("beta", s.newmark_beta, false, tell);
  tell_of_number("gamma", s.newmark_gamma, true, tell);
  if (!(s.step_tolerance > 0 && s.step_tolerance < 1))
    tell(Error(fmt::format("stepTolerance = {} is not in (0, 1)", s.step_tolerance)));
  if (s.arc_length.on && s.integrator != Integrator::static_)
    tell(Error(fmt::format("arcLength follows static equilibria, but timeIntegration is {}: choose static",
                           name(s.integrator))));
  tell_of_number("arcSteps", s.arc_length.steps, false, tell);
  if (s.arc_length.on && s.newton_iterations == 1)
    tell(
        Error("newtonIterations = 1 does not go with arcLength, which finds the load and the displacement of a step "
              "together, in several iterations: take 2 or more, such as the usual 25"));
  if (s.adaptive_step && is_explicit(s.integrator))
    tell(
        Error(fmt::format("adaptiveStep = true does not go with the explicit timeIntegration = {}, whose dt is that "
                          "of the step: leave adaptiveStep out, or choose an implicit timeIntegration",
                          name(s.integrator))));
  if (s.adaptive_step && s.arc_length.on)
    tell(Error("adaptiveStep = true does not go with arcLength, which adapts its own steps: leave adaptiveStep out"));
  if (!(s.spectral_radius >= 0 && s.spectral_radius <= 1))
    tell(Error(fmt::format("spectralRadius = {} is not in [0, 1]", s.spectral_radius)));
  if (s.integrator != Integrator::newmark || s.allow_unstable) return;
  if (s.newmark_gamma < 0.5 || 2 * s.newmark_beta < s.newmark_gamma)
    tell(Error(
        fmt::format("Newmark with beta = {}, gamma = {} grows without bound at some time steps: take gamma >= 1/2 and "
                    "beta >= gamma/2, or allowUnstable = true",
                    s.newmark_beta, s.newmark_gamma)));
}

void check_cells(Formulation formulation, CellKind kind, const Tell& tell) {
  if (formulation == Formulation::single_rotation && kind != CellKind::tet10)
    tell(Error(fmt::format("formulation = singleRotation is for quadraticTet, the elements are {}", name(kind))));
  if (formulation == Formulation::mixed && kind != CellKind::tet10)
    tell(Error(
        fmt::format("formulation=\"mixed\" is for quadraticTet (quadratic displacement, linear pressure); the body has "
                    "{} cells",
                    name(kind))));
  if (formulation == Formulation::fbar && kind != CellKind::tet4)
    tell(Error(
        fmt::format("formulation=\"fbar\" is for linearTet (volume changes averaged over patches); the body has {} "
                    "cells",
                    name(kind))));
}

void check_split(const Model& model, const Region& region, const std::optional<Split>& split, const Tell& tell) {
  const char* formulation = spelled(model.formulation);
  if (!split) {
    tell(
        Error(fmt::format("region '{}': {} has no volumetric part of its own, which formulation=\"{}\" needs; choose "
                          "formulation=\"standard\" or another material",
                          region.name, region.law->name(), formulation)));
    return;
  }
  if (!(split->modulus[0] > 0))
    tell(Error(
        fmt::format("region '{}': the volumetric modulus of {} is {:g}, not > 0 as formulation=\"{}\" needs; choose "
                    "formulation=\"standard\" or a poissonRatio > 0",
                    region.name, region.law->name(), split->modulus[0], formulation)));
}

void check_plane_stress(const Region& region, const Tell& tell) {
  try {
    make_plane_stress(region.law);
  } catch (const Error& error) {
    tell(Error(fmt::format("region '{}': {}", region.name, error.what())));
  }
}

const char* unknown_of(const Law& law) { return law.components() == 1 ? "a scalar unknown" : "displacements"; }

bool scalar(const Model& model) {
  return std::ranges::any_of(model.regions, [](const Region& r) { return r.law && r.law->components() == 1; });
}

}  // namespace

void raise(const Error& error) { throw error; }

void check_number(const char* what, double value, bool zero_allowed) {
  tell_of_number(what, value, zero_allowed, raise);
}

void check_settings(const Settings& s, const Tell& tell) {
  tell_of_number("dampingRayleighRatioMass", s.damping_mass, true, tell);
  tell_of_number("dampingRayleighRatioStiffness", s.damping_stiffness, true, tell);
  tell_of_number("tolerance", s.tolerance, false, tell);
  tell_of_number("linearTolerance", s.linear_tolerance, false, tell);
  if (s.tolerance >= 1) tell(Error(fmt::format("tolerance = {} is not in (0, 1)", s.tolerance)));
  if (s.linear_tolerance >= 1) tell(Error(fmt::format("linearTolerance = {} is not in (0, 1)", s.linear_tolerance)));
  tell_of_number("newtonIterations", s.newton_iterations, false, tell);
  tell_of_number("loadSteps", s.load_steps, false, tell);
  tell_of_number("threads", s.threads, false, tell);
  check_integrator(s, tell);
}

void check_elements(const Model& model, CellKind kind, const Tell& tell) {
  check_cells(model.formulation, kind, tell);
  if (model.quadrature != 4 && (model.quadrature != 8 || kind != CellKind::tet10))
    tell(Error(fmt::format("quadrature = {} is not 4, or 8 for quadraticTet", model.quadrature)));
  if (model.quadrature != 4 && model.formulation != Formulation::standard && model.formulation != Formulation::mixed)
    tell(Error(fmt::format(
        "quadrature = {} needs formulation = standard or mixed, but it is {}: take quadrature = 4 or leave it out",
        model.quadrature, spelled(model.formulation))));
  tell_of_number("thickness", model.thickness, false, tell);
  if (model.plane == Plane::stress && dimension(kind) != 2)
    tell(Error(fmt::format("plane = stress is for triangles, the elements are {}", name(kind))));
}

void check_law(const Model& model, const Region& region, const Tell& tell) {
  if (!region.law) return;
  const std::optional<Split> split = region.law->split();
  const bool incompressible = region.law->incompressible() || (split && !std::isfinite(split->modulus[0]));
  if (incompressible && model.formulation != Formulation::mixed)
    tell(Error(
        fmt::format("region '{}': {} is incompressible, which needs a mesh with formulation=\"mixed\" (quadraticTet); "
                    "or choose a poissonRatio below 0.5, a finite bulkModulus",
                    region.name, region.law->name())));
  if (model.formulation == Formulation::single_rotation &&
      (region.law->name() != "linearElasticMaterial" || region.law->small_strain()))
    tell(Error(
        fmt::format("region '{}': formulation = singleRotation is for linearElasticMaterial with strain = corotated; "
                    "its law is {}{}",
                    region.name, region.law->name(), region.law->small_strain() ? " of small strain" : "")));
  if (model.plane == Plane::stress && region.law->components() == 1)
    tell(
        Error(fmt::format("region '{}': plane=\"stress\" is about displacements, which {} does not have; leave plane "
                          "out",
                          region.name, region.law->name())));
  if (model.plane == Plane::stress && region.law->components() > 1) check_plane_stress(region, tell);
  if (splits(model.formulation)) check_split(model, region, split, tell);
}

void check_prony(const Model& model, const Region& region, const Tell& tell) {
  const Prony& prony = region.prony;
  if (prony.g.size() != prony.tau.size())
    tell(Error(fmt::format("region '{}': prony has {} values of g and {} of tau: one of each per term", region.name,
                           prony.g.size(), prony.tau.size())));
  if (prony.g.empty() || prony.g.size() != prony.tau.size()) return;
  double sum = 0;
  for (std::size_t i = 0; i < prony.g.size(); ++i) {
    sum += prony.g[i];
    if (!std::isfinite(prony.g[i]) || prony.g[i] < 0)
      tell(Error(fmt::format("region '{}': prony: g = {} is not >= 0", region.name, prony.g[i])));
    if (!std::isfinite(prony.tau[i]) || prony.tau[i] <= 0)
      tell(Error(fmt::format("region '{}': prony: tau = {} is not > 0", region.name, prony.tau[i])));
  }
  if (sum >= 1) tell(Error(fmt::format("region '{}': prony: the sum of g = {} is not < 1", region.name, sum)));
  if (region.law && region.law->components() == 1)
    tell(Error(fmt::format("region '{}': prony is for stresses, which {} does not have; leave prony out", region.name,
                           region.law->name())));
  if (model.settings.arc_length.on)
    tell(
        Error(fmt::format("region '{}': prony needs time, but arcLength follows equilibria along the load; leave "
                          "out prony or arcLength",
                          region.name)));
}

void check_same_unknown(const Region& first, const Region& region, const Tell& tell) {
  if (!first.law || !region.law || first.law->components() == region.law->components()) return;
  tell(Error(fmt::format(
      "region '{}' has a law of {} ({}), but region '{}' one of {} ({}): one kind of problem at a time", region.name,
      unknown_of(*region.law), region.law->name(), first.name, unknown_of(*first.law), first.law->name())));
}

void check_preconditioner(const Model& model, CellKind kind, const Tell& tell) {
  const Settings& settings = model.settings;
  if (settings.preconditioner != Preconditioner::multigrid || is_explicit(settings.integrator) ||
      settings.linear_solver == LinearSolver::direct || (dimension(kind) == 3 && !scalar(model)))
    return;
  tell(
      Error(fmt::format("preconditioner=\"multigrid\" is for displacements of tetrahedra, but {}; choose "
                        "incompleteCholesky, blockJacobi or auto",
                        scalar(model) ? "the unknown is a number" : fmt::format("the elements are {}", name(kind)))));
}

void check_problem(const Model& model, const Tell& tell) {
  const Settings& settings = model.settings;
  if (scalar(model) && is_dynamic(settings.integrator))
    tell(
        Error(fmt::format("a scalar problem (diffusionMaterial) is stationary, but timeIntegration is {}: choose "
                          "timeIntegration=\"static\" or \"quasiStatic\"",
                          name(settings.integrator))));
  if (model.formulation != Formulation::mixed) return;
  if (is_explicit(settings.integrator))
    tell(Error(
        fmt::format("timeIntegration=\"{}\" is explicit, but the pressure of formulation=\"mixed\" has to be solved "
                    "for; choose an implicit one, or formulation=\"fbar\" with linearTet",
                    name(settings.integrator))));
  if (settings.linear_solver == LinearSolver::cg)
    tell(
        Error("linearSolver=\"CG\" (and \"GMRES\", which is taken as it) needs a positive definite matrix, which "
              "formulation=\"mixed\" does not give; choose linearSolver=\"direct\""));
}

}  // namespace msml::fe
