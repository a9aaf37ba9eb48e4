// SPDX-License-Identifier: GPL-3.0-or-later
// Says in plain words why a run stopped and what to try.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

bool incompressible(const Model& model) {
  return std::ranges::any_of(model.regions, [](const Region& region) { return region.law->incompressible(); });
}

/// Newmark's average acceleration balances the pressures of incompressible regions at the ends of steps alone: between
/// large motions they swing from step to step, and no smaller one helps.
bool pressures_swing(const Model& model) {
  return model.settings.integrator == Integrator::newmark && incompressible(model);
}

std::string advice(const Run& run, const IncrementResult& result) {
  const bool loaded_in_parts = run.model.settings.integrator == Integrator::static_;
  const std::string smaller = loaded_in_parts ? "more loadSteps, or smaller loads" : "a smaller dt";
  if (run.equations.numbering().scalar && result.stop == Stop::indefinite_tangent)
    return "the coefficient is not positive everywhere, so that there is no single answer: check it";
  // Supports that made the matrix regular once hold the body.
  const bool was_regular = result.residuals.size() > 1 || run.now.increment > 0;
  switch (result.stop) {
    case Stop::newton_limit:
      return "try " + smaller + ", or more newtonIterations";
    case Stop::diverged:
      return "try " + smaller + "; check units, loads and material stiffness";
    case Stop::inverted_element:
      return "try " + smaller + ", a finer or better mesh at that element, or a stiffer material";
    case Stop::indefinite_tangent:
      return "the body buckles or the equilibrium is unstable: try smaller loads, or a dynamic timeIntegration";
    case Stop::linear_solver_limit:
      return "try linearSolver=\"direct\", another preconditioner, a better mesh or poissonRatio further from 0.5";
    case Stop::step_too_large:
      if (pressures_swing(run.model))
        return "the pressures of incompressible regions swing under Newmark's method: take "
               "timeIntegration=\"generalizedAlpha\" or \"dynamicImplicitEuler\"";
      return loaded_in_parts ? "take more loadSteps, or adaptiveStep=\"true\""
                             : "take dt as small as that, or adaptiveStep=\"true\"";
    case Stop::bad_element:
      return "improve the mesh there: without slivers, or finer";
    case Stop::collapsed:
      return "the body rests with a part turned inside out or crushed to nothing, a trap of the energy: start from a "
             "slightly changed state, take a law that pushes back (neoHookeanMaterial form=\"stable\", or "
             "inversion=\"clamped\"), a dynamic timeIntegration, or allowInverted=\"true\" if it is meant";
    case Stop::singular:
      if (was_regular)
        return "the body lost its stiffness on the way: the loads pass a limit point, or the law softens without end. "
               "Try " +
               smaller + ", arcLength=\"true\", a dynamic timeIntegration, or another law";
      if (run.equations.numbering().scalar) return "a part of the body has no fixedValue: give it one";
      if (incompressible(run.model))
        return "either a part of the body can move freely: fix it; or supports hold an incompressible region all "
               "around, "
               "which leaves its pressure open: set a part of its surface free, or take a finite bulkModulus";
      return "either a part of the body can move freely: fix it, or join parts that touch only at a node or an edge; "
             "or "
             "its stiffnesses lie too far apart to be told from nothing: flat elements, a poissonRatio too near 0.5";
    case Stop::out_of_memory:
      return "try linearSolver=\"CG\" or a coarser mesh";
    default:
      return "";
  }
}

std::string residual_text(const IncrementResult& result) {
  if (result.residuals.empty()) return "none";
  std::string text;
  for (const double r : result.residuals)
    text += (text.empty() ? "" : " ") + (std::isfinite(r) ? fmt::format("{:.2e}", r) : "beyond numbers");
  return text + fmt::format(" (forces are of the size {:.2e})", result.scale);
}

/// Which of Newton's criteria is not met; "" where the iteration ended for another reason.
std::string criteria_text(const Run& run, const IncrementResult& result) {
  const bool limit = result.stop == Stop::newton_limit || result.stop == Stop::step_too_large;
  if (!limit || result.residuals.empty()) return "";
  const double tolerance = run.model.settings.tolerance;
  if (result.missing_way < 0)
    return fmt::format(": the criterion of the residual is not met, tolerance = {:g} of that size", tolerance);
  std::string failed;
  if (!(result.missing_way <= tolerance))
    failed += fmt::format(" increment ({:.2g} of the displacement is missing)", result.missing_way);
  if (!(result.missing_energy <= tolerance))
    failed +=
        fmt::format("{} energy ({:.2g} of its norm is missing)", failed.empty() ? "" : " and", result.missing_energy);
  return fmt::format(": within tolerance = {:g} for the residual, but not for{}", tolerance, failed);
}

std::string element_text(const Run& run, const IncrementResult& result) {
  if (result.worst_element < 0) return "";
  const Mesh& mesh = *run.model.mesh;
  const int* nodes = mesh.cell(result.worst_element);
  Vec3 centre = Vec3::Zero();
  const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(result.worst_element)]);
  for (int a = 0; a < corners; ++a) centre += mesh.points.row(nodes[a]).transpose() / corners;
  return fmt::format("; worst element {} at ({:g} {:g} {:g}), det F = {:g}", result.worst_element, centre[0], centre[1],
                     centre[2], result.worst_J);
}

std::string node_text(const Run& run, const IncrementResult& result) {
  if (result.worst_node < 0) return "";
  const auto x = run.model.mesh->points.row(result.worst_node);
  return fmt::format("; largest residual at node {} at ({:g} {:g} {:g})", result.worst_node, x[0], x[1], x[2]);
}

constexpr double flat = 1e-9;  // det F = 0 comes with either sign

}  // namespace

void Run::judge_end() {
  const Settings& settings = model.settings;
  if (!is_dynamic(settings.integrator) || outcome.stop != Stop::converged || equations.small_strain()) return;
  IncrementResult end;
  end.worst_element = newton.forces().found.smallest_J_element;
  end.stop = Stop::inverted_element;
  end.worst_J = newton.forces().found.smallest_J;
  if (end.worst_element >= 0 && end.worst_J <= flat && !settings.allow_inverted) {
    outcome.stop = end.stop;
    outcome.diagnosis = fmt::format(
        "step {} '{}' ended at time {:g} in a state that is none of a body: {}{}; {}. A motion may pass through such "
        "states, but not end in one: allowInverted=\"true\" takes it",
        now.step + 1, model.steps[static_cast<std::size_t>(now.step)].name, now.time, name(end.stop),
        element_text(*this, end), advice(*this, end));
  } else if (last_inverted) {
    outcome.notes.push_back(fmt::format("elements were inside out on the way, from time {:.4g} to {:.4g}",
                                        *first_inverted, *last_inverted));
  }
}

void explain(Run& run, const IncrementResult& result, double share, const std::string& evidence) {
  const Step& step = run.model.steps[static_cast<std::size_t>(run.now.step)];
  const std::string when = share >= 0 ? fmt::format("at {:.4g} of the loads", share)
                                      : fmt::format("in increment {}, from time {:g} with dt = {:g}",
                                                    run.now.increment + 1, run.now.time, step.dt);
  run.residuals = result.residuals;
  run.outcome.stop = result.stop;
  run.outcome.diagnosis =
      fmt::format("step {} '{}' stopped {}: {}{}{}; residuals {}{}{}{}; {}", run.now.step + 1, step.name, when,
                  name(result.stop), evidence.empty() ? "" : ": ", evidence, residual_text(result),
                  criteria_text(run, result), element_text(run, result), node_text(run, result), advice(run, result));
}

}  // namespace msml::fe
