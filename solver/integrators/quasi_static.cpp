// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium at each time step of a load history: time passes for loads, supports and materials, but not for masses.
#include "solver/integrators/stepper.hpp"

namespace msml::fe {

void run_quasi_static(Run& run) {
  const Model& model = run.model;
  if (!run.start_at_rest()) return;
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    EquilibriumPath path = begin_path(run, static_cast<int>(s));
    const LoadSet* set = &run.equations.loads(run.now.step);
    run.hold(step, path.supports.fixed);
    path.loads = [&](double share) { return ScaledLoads{{set, 1.0, path.time(share)}}; };
    for (int k = 1; k <= step.count; ++k)
      if (!advance(run, path, (k - 1.0) / step.count, static_cast<double>(k) / step.count) || !run.accept()) return;
  }
}

}  // namespace msml::fe
