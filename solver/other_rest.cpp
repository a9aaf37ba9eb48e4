// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for stresses that nothing outside the body asks for.
#include "solver/other_rest.hpp"

#include <fmt/format.h>

#include <cmath>

namespace msml::fe {
namespace {

bool at_rest(const Run& run, const Energies& energies) {
  const Forces& f = run.newton.forces();
  return f.inertia.norm() <= 1e-3 * f.internal.norm() && energies.kinetic <= 1e-6 * energies.elastic;
}

/// Supports that have moved along their reactions have done work.
bool supports_moved(const Run& run) {
  const Vector &r = run.now.reaction, &u = run.now.u;
  double work = 0, forces = 0;
  for (Eigen::Index k = 0; k < r.size(); k += 3) {
    work += std::abs(r.segment<3>(k).dot(u.segment<3>(k)));
    forces += r.segment<3>(k).norm();
  }
  return work > 1e-9 * forces * u.cwiseAbs().maxCoeff();
}

}  // namespace

std::string warning_of_other_rest(const Run& run, const Check& check) {
  const Equations& equations = run.equations;
  const Step& step = run.model.steps[static_cast<std::size_t>(run.now.step)];
  const bool own = !equations.numbering().scalar && !equations.small_strain() && !equations.has_history() &&
                   !equations.has_followers() && step.springs.empty();
  if (!own || run.outcome.stop != Stop::converged || !(check.largest_strain > 0.01)) return "";
  const Energies& energies = run.outcome.state.energies;
  if (run.newton.forces().external.norm() > 0 || !at_rest(run, energies) || supports_moved(run)) return "";
  return fmt::format(
      "no load acts and no support has moved, yet the body holds the energy {:.4g} and is strained by up to {:.3g}: it "
      "rests in another equilibrium than its reference shape, tangled, turned inside out or snapped through. Start "
      "nearer to rest, or take neoHookeanMaterial form=\"stable\"",
      energies.elastic, check.largest_strain);
}

}  // namespace msml::fe
