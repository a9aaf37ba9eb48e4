// SPDX-License-Identifier: GPL-3.0-or-later
// The entry point: prepares the equations, runs the integrator, fills the check.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "solver/check_answer.hpp"
#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

State state_of(const Numbering& numbering, const Motion& now) {
  return {now.time,
          now.step,
          now.increment,
          to_points(numbering, now.u),
          to_points(numbering, now.v),
          to_points(numbering, now.a),
          to_points(numbering, now.reaction)};
}

Outcome run_model(const Model& model, const Observer& observer) {
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  const Equations equations(model);
  Newton newton(model, equations);
  const Vector zero = Vector::Zero(equations.size());
  Run run{model, equations, newton, observer, outcome, {zero, zero, zero, zero, 0, 0, 0}, {}};
  outcome.seconds_setup = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.state = state_of(equations.numbering(), run.now);
  if (model.settings.integrator == Integrator::static_)
    run_static(run);
  else
    run_dynamic(run);
  outcome.unknowns = count_unknowns(model, equations.numbering(), run.now.step);
  newton.report(outcome);
  outcome.state = state_of(equations.numbering(), run.now);
  outcome.check = check_answer(run);
  return outcome;
}

}  // namespace

const char* name(Stop stop) {
  switch (stop) {
    case Stop::converged:
      return "converged";
    case Stop::newton_limit:
      return "Newton iteration limit";
    case Stop::diverged:
      return "diverged";
    case Stop::inverted_element:
      return "inverted element";
    case Stop::indefinite_tangent:
      return "indefinite tangent";
    case Stop::linear_solver_limit:
      return "linear solver limit";
    case Stop::singular:
      return "singular matrix";
    case Stop::interrupted:
      return "interrupted";
    case Stop::out_of_memory:
      return "out of memory";
  }
  return "unknown";
}

bool Run::accept() {
  if (!observer || observer(state_of(equations.numbering(), now))) return true;
  outcome.stop = Stop::interrupted;
  outcome.diagnosis = fmt::format("interrupted at time {:g}, after {} increments", now.time, now.increment);
  return false;
}

void Run::set_reactions(const Mask& fixed) {
  now.reaction = -newton.forces().residual();
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (!fixed[k]) now.reaction[static_cast<Eigen::Index>(k)] = 0;
}

Outcome solve(const Model& model, const Observer& observer) {
  model.check();
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(std::min(model.settings.threads, static_cast<int>(allowed)));
  return arena.execute([&] { return run_model(model, observer); });
}

}  // namespace msml::fe
