// SPDX-License-Identifier: GPL-3.0-or-later
// The entry point: prepares the equations, runs the integrator, fills the check.
#include <fmt/format.h>
#include <malloc.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "solver/check_answer.hpp"
#include "solver/energy_gain.hpp"
#include "solver/integrators/stepper.hpp"
#include "solver/other_rest.hpp"

namespace msml::fe {
namespace {

void integrate(Run& run) {
  switch (run.model.settings.integrator) {
    case Integrator::static_:
      return run.model.settings.arc_length.on ? run_arc_length(run) : run_static(run);
    case Integrator::quasi_static:
      return run_quasi_static(run);
    case Integrator::forward_euler:
    case Integrator::symplectic_euler:
    case Integrator::central_difference:
      return run_explicit(run);
    default:
      return run_implicit(run);
  }
}

/// A static answer that is none: with newtonIterations = 1 the program takes what one linear solve gives.
std::string warning_of_imbalance(const Model& model, const Outcome& outcome) {
  const bool settles =
      model.settings.integrator == Integrator::static_ || model.settings.integrator == Integrator::quasi_static;
  const double allowed = std::max(1e-4, 100 * model.settings.tolerance);
  // A body that has come to rest holds no forces that a residual could be measured by: Newton's method has seen to it.
  if (model.settings.newton_iterations > 1) return "";
  if (!settles || outcome.stop != Stop::converged || !(outcome.check.residual > allowed)) return "";
  return fmt::format(
      "the forces are out of balance by {:.3g} of their size: this is not an equilibrium. Allow more newtonIterations "
      "than {}, or apply the loads in more loadSteps",
      outcome.check.residual, model.settings.newton_iterations);
}

/// Notes what the run holds beside what Newton's method has noted.
void note_memory(const Run& run, Outcome& outcome) {
  const Motion& now = run.now;
  std::size_t vectors =
      run.newton.forces().bytes() + bytes(run.external_before) + bytes(run.reaction_before) + bytes(run.damping_before);
  for (const Vector* v : {&now.u, &now.v, &now.a, &now.reaction, &run.equations.positions()}) vectors += bytes(*v);
  for (const Points* p :
       {&outcome.state.displacement, &outcome.state.velocity, &outcome.state.acceleration, &outcome.state.reaction})
    vectors += static_cast<std::size_t>(p->size()) * sizeof(double);
  for (int step = 0; step < static_cast<int>(run.model.steps.size()); ++step)
    vectors += bytes(run.equations.loads(step).dead);
  for (const Region& region : run.model.regions) vectors += region.elements.size() * sizeof(int);
  outcome.held.push_back({"elements", run.equations.elements().bytes()});
  outcome.held.push_back({"mass", run.equations.mass().values.size() * sizeof(double)});
  outcome.held.push_back({"vectors", vectors});
}

/// Large arrays that a static solution drops go back to the system at once. Left alone, glibc keeps more of them with
/// every one it sees, with holes between them: 2 % of the peak at nu = 0.49. Time steps ask for the same ones again.
void give_back_large_arrays() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

Outcome run_model(const Model& model, const Observer& observer) {
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  Equations equations(model);
  Newton newton(model, equations);
  const Vector zero = Vector::Zero(equations.size());
  const auto start = [&](const Points& values) {
    return values.rows() > 0 ? to_vector(equations.numbering(), values) : zero;
  };
  Run run{model,    equations, newton,
          observer, outcome,   {start(model.initial_displacement), start(model.initial_velocity), zero, zero}};
  outcome.seconds_setup = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  integrate(run);
  outcome.unknowns = count_unknowns(model, equations.numbering(), run.now.step);
  newton.report(outcome);
  if (run.halved > 0) outcome.recoveries.push_back(fmt::format("{} steps failed and were halved", run.halved));
  if (run.untangled > 0) outcome.recoveries.emplace_back("a stable law led out of states with inverted elements");
  if (run.untangled > 0)
    outcome.notes.push_back(
        fmt::format("{} increments began with elements inside out or crushed; the stable "
                    "neo-Hookean law led the body out of it, and its own laws went on from there",
                    run.untangled));
  if (run.unsettled > 0)
    outcome.warnings.push_back(
        fmt::format("in {} time steps what damps turned or stiffened so far that its forces did not settle on those of "
                    "the end of the step: take a smaller dt",
                    run.unsettled));
  outcome.state = run.state();
  note_memory(run, outcome);
  outcome.check = check_answer(run);
  run.judge_end();
  for (const std::string& warning :
       {warning_of_imbalance(model, outcome), warning_of_other_rest(run, outcome.check), warning_of_energy_gain(run)})
    if (!warning.empty()) outcome.warnings.push_back(warning);
  return outcome;
}

}  // namespace

Outcome solve(const Model& model, const Observer& observer) {
  model.check();
  if (model.settings.integrator == Integrator::static_) give_back_large_arrays();
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(std::min(model.settings.threads, static_cast<int>(allowed)));
  return arena.execute([&] { return run_model(model, observer); });
}

}  // namespace msml::fe
