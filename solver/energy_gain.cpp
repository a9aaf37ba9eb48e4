// SPDX-License-Identifier: GPL-3.0-or-later
// Balances the energy of a whole run.
#include "solver/energy_gain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

std::string warning_of_energy_gain(const Run& run) {
  const Equations& equations = run.equations;
  if (!is_dynamic(run.model.settings.integrator) || equations.numbering().scalar || equations.has_history()) return "";
  if (!run.energy_at_start || supports_move(run.model)) return "";
  const Energies& energies = run.now.energies;
  const double held = energies.elastic + energies.kinetic, start = *run.energy_at_start;
  const double gain = held + energies.dissipated - energies.external_work - start;
  if (!(gain > 0.5 * std::max({held, std::abs(energies.external_work), energies.dissipated, start}))) return "";
  return fmt::format(
      "the body holds the energy {:.4g} at the end, of which {:.4g} came from neither its start ({:.4g}) nor loads "
      "({:.4g}): the time integration makes energy and the motion is not to be trusted. Take a smaller dt, more "
      "newtonIterations, or timeIntegration = \"dynamicImplicitEuler\" or \"generalizedAlpha\"",
      held, gain, start, energies.external_work);
}

}  // namespace msml::fe
