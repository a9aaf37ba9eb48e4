// SPDX-License-Identifier: GPL-3.0-or-later
// Static equilibrium: loads grow from what the step before left to what this step asks for.
#include "solver/integrators/stepper.hpp"

namespace msml::fe {

void run_static(Run& run) {
  const Model& model = run.model;
  const int parts = model.settings.load_steps;
  if (!run.start_at_rest()) return;
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    const Step& step = model.steps[s];
    EquilibriumPath path = begin_path(run, static_cast<int>(s));
    const LoadSet* goal = &run.equations.loads(run.now.step);
    const LoadSet* before = s > 0 ? &run.equations.loads(run.now.step - 1) : nullptr;
    run.hold(step, path.supports.fixed);
    path.loads = [&](double share) {
      ScaledLoads loads{{goal, share, path.time(share)}};
      if (before && share < 1) loads.push_back({before, 1 - share, path.start, true});
      return loads;
    };
    for (int part = 1; part <= parts; ++part)
      if (!advance(run, path, (part - 1.0) / parts, static_cast<double>(part) / parts) || !run.accept()) return;
  }
}

}  // namespace msml::fe
