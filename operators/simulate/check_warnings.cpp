// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings that follow from a run.
#include <cmath>

#include "operators/simulate/check_report.hpp"
#include "operators/simulate/records.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

constexpr double locking_ratio = 0.45;      // poissonRatio from which linear tetrahedra lock
constexpr double small_rotation = 10;       // degrees that small strain may rotate
constexpr double near_inversion = 0.1;      // J
constexpr double tolerable_damping = 0.05;  // amplitude lost per cycle of the lowest period
constexpr double sliver_angle = 1;          // degrees

void warn_of_locking(const Simulation& simulation, std::vector<std::string>& warnings) {
  if (simulation.model.formulation == fe::Formulation::fbar) return;
  const bool plane = simulation.body.kind == CellKind::tri3 && simulation.model.plane == fe::Plane::strain;
  if (simulation.body.kind != CellKind::tet4 && !plane) return;
  for (const fe::Region& region : simulation.model.regions)
    if (region.law->poisson_ratio() >= locking_ratio)
      warnings.push_back(fmt::format(
          "region '{}' has poissonRatio = {}: linear {} lock (are too stiff) from {}. Use {}", region.name,
          region.law->poisson_ratio(), plane ? "triangles" : "tetrahedra", locking_ratio,
          plane ? "quadraticTriangle"
                : "formulation=\"fbar\", or quadraticTet with the mesh from ConvertLinearToQuadraticTetrahedralMesh"));
}

/// Implicit Euler damps a period T by 1 - exp(-2 pi^2 dt/T) per cycle for small dt/T.
double tolerable_step(double period) { return -std::log(1 - tolerable_damping) * period / (2 * EIGEN_PI * EIGEN_PI); }

}  // namespace

std::vector<std::string> check_warnings(const Simulation& simulation, const fe::Outcome& outcome,
                                        const WorstShape& worst) {
  std::vector<std::string> warnings = outcome.warnings;
  const fe::Check& check = outcome.check;
  warn_of_locking(simulation, warnings);
  if (simulation.body.small_strain && check.largest_rotation > small_rotation)
    warnings.push_back(
        fmt::format("an element rotates by {:.3g} degrees, but strain = \"small\" holds up to about {}. Use "
                    "strain = \"corotated\"",
                    check.largest_rotation, small_rotation));
  if (check.smallest_J < near_inversion)
    warnings.push_back(fmt::format(
        "element {} at {} is {}. Lower the load, or refine the mesh there", check.smallest_J_element,
        check.smallest_J_element < 0 ? std::string("an unknown place")
                                     : place(centroid(*simulation.body.mesh, check.smallest_J_element)),
        check.smallest_J <= 0 ? fmt::format("inverted: J = {:.3g}", check.smallest_J)
                              : fmt::format("near inversion: J = {:.3g}, below {}", check.smallest_J, near_inversion)));
  if (check.damped_per_cycle > tolerable_damping)
    warnings.push_back(
        fmt::format("the time step damps the lowest period, {:.3g}, by {:.3g} % a cycle. Take {}dt below "
                    "{:.2g}, or timeIntegration = \"Newmark\"",
                    check.lowest_period, 100 * check.damped_per_cycle,
                    simulation.model.settings.adaptive_step ? "a smaller stepTolerance, or " : "",
                    tolerable_step(check.lowest_period)));
  if (outcome.cg_gave_up)
    warnings.push_back(
        "conjugate gradients missed linearTolerance, so the matrix was factorised from then on. Use "
        "linearSolver = \"direct\", or improve the mesh");
  if (worst.smallest_angle < sliver_angle)
    warnings.push_back(fmt::format("element {} at {} is a sliver: {} angle of {:.3g} degrees. Improve the mesh{}",
                                   worst.angle_element, place(centroid(*simulation.body.mesh, worst.angle_element)),
                                   dimension(simulation.body.kind) == 3 ? "a dihedral" : "an", worst.smallest_angle,
                                   dimension(simulation.body.kind) == 3 ? ", for example with exude = \"true\"" : ""));
  return warnings;
}

}  // namespace msml::simulation
