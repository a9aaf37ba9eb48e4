// SPDX-License-Identifier: GPL-3.0-or-later
// Balances the energy of a whole run.
#include "solver/energy_gain.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace msml::fe {
namespace {

bool moves(const Prescribed& support) {
  const bool values =
      std::any_of(support.values.begin(), support.values.end(), [](const Vec3& v) { return !v.isZero(); });
  return values || support.function || support.factor;
}

bool supports_move(const Model& model) {
  return std::any_of(model.steps.begin(), model.steps.end(), [](const Step& step) {
    return std::any_of(step.prescribed.begin(), step.prescribed.end(), moves);
  });
}

/// Methods that lose energy as they should.
bool damps(const Settings& settings) {
  return settings.integrator == Integrator::implicit_euler || settings.integrator == Integrator::generalized_alpha ||
         (settings.integrator == Integrator::newmark && settings.newmark_gamma > 0.5);
}

}  // namespace

std::string warning_of_energy_gain(const Run& run) {
  const Equations& equations = run.equations;
  if (!is_dynamic(run.model.settings.integrator) || equations.numbering().scalar || equations.has_history()) return "";
  if (supports_move(run.model)) return "";
  const double half = 0.5 * run.most_energy;
  if (run.most_gained > half)
    return fmt::format(
        "of an energy of up to {:.4g}, {:.4g} came from neither the start nor loads: the time integration makes "
        "energy, "
        "and the motion is not to be trusted. Take a smaller dt, more newtonIterations, or timeIntegration = "
        "\"dynamicImplicitEuler\" or \"generalizedAlpha\"",
        run.most_energy, run.most_gained);
  if (const double swing = run.most_gained + run.most_lost; swing > half && !damps(run.model.settings))
    return fmt::format(
        "of an energy of up to {:.4g}, {:.4g} came and went in a time integration that should keep it: the motion is "
        "not to be trusted. Take a smaller dt, or more newtonIterations",
        run.most_energy, swing);
  return "";
}

}  // namespace msml::fe
