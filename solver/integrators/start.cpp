// SPDX-License-Identifier: GPL-3.0-or-later
// What a run begins with: whether it makes sense, what supports and incompressible regions make of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/core/error.hpp"
#include "solver/integrators/stepper.hpp"
#include "solver/kept_volume.hpp"

namespace msml::fe {
namespace {

/// Of the change of volume beside the largest gradient. A field that keeps volumes changes them by its interpolation on
/// the mesh alone, which is taken away: a twist by 0.8 % where it turns by 45 degrees over an element, vortices by 3 %
/// where two elements make a quarter of a turn, and four times less on a mesh of half the size. One that does not keep
/// them changes them by about its gradients.
constexpr double tolerable_change = 0.1;
constexpr double seen_jump = 1e-6;         // of the speed of supports, beside the largest speed
constexpr double noted_correction = 1e-6;  // of an initial displacement or velocity, beside the largest

/// `rate`: the field is a velocity.
void refuse_change(const Mesh& mesh, const VolumeChange& found, bool rate) {
  if (found.relative <= tolerable_change || found.element < 0) return;
  Vec3 centre = Vec3::Zero();
  for (int corner = 0; corner < 4; ++corner)
    centre += mesh.points.row(mesh.cell(found.element)[corner]).transpose() / 4;
  throw Error(fmt::format(
      "{}: it changes volumes that incompressible=\"true\" keeps: around element {} at ({:g} {:g} {:g}) by {:.3g} of "
      "them{}, beside gradients of {:.3g}. At a corner there the share of these is {:.2g}, and a mesh that is fine "
      "enough leaves less than {:g}. Take a "
      "field that keeps volumes (a rotation, a shear, {}) over whole bodies, or a finer mesh, or a finite bulkModulus",
      rate ? "initialVelocity" : "initialDisplacement", found.element, centre[0], centre[1], centre[2], found.change,
      rate ? " per time" : "", found.gradient, found.relative, tolerable_change,
      rate ? "a velocity with the divergence 0" : "a displacement with det F = 1"));
}

}  // namespace

void Run::halt(const Supports& supports) {
  for (std::size_t k = 0; k < supports.fixed.size(); ++k)
    if (supports.fixed[k] && supports.moved_by[k] < 0) now.v[static_cast<Eigen::Index>(k)] = 0;
  supports.slides.project(now.v);
}

void Run::hold_start(const Supports& supports) {
  const Vector given = now.v;
  halt(supports);
  long nodes = 0;
  for (Eigen::Index k = 0; k < given.size(); k += 3)
    nodes += (given - now.v).segment<3>(k).norm() > 1e-12 * given.segment<3>(k).norm();
  if (nodes > 0)
    outcome.notes.push_back(
        fmt::format("the initial velocity is left out where supports hold the body: at {} nodes", nodes));
}

bool Run::sound_start() {
  const Assembled& found = newton.forces().found;
  if (found.finite && std::isfinite(found.energy)) {
    if (equations.has_history()) equations.end_step(now.u);  // a sudden strain
    return true;
  }
  IncrementResult result;
  result.worst_element = found.smallest_J_element;
  result.worst_J = found.smallest_J;
  result.stop = newton.state_verdict() == Stop::inverted_element ? Stop::inverted_element : Stop::diverged;
  explain(*this, result, -1);
  outcome.diagnosis +=
      "; the run begins in this state, where the law has no forces: change initialDisplacement, or take a law that "
      "survives inversion (neoHookeanMaterial form=\"stable\")";
  return false;
}

void Run::settle_pressures() {
  if (now.u.isZero(0)) return;
  if (newton.settle_pressures(now.u) > 0 && !is_dynamic(model.settings.integrator))
    outcome.notes.push_back(
        "the initial displacement says nothing of the pressure in incompressible regions: the state that Newton's "
        "method starts from has none there, and its stress is without it");
}

Mask Run::kept_volumes() {
  if (!equations.numbering().mixed()) return {};
  newton.prepare(now.u, {});
  const Mask open = open_pressures(equations.numbering(), newton.tangent());
  return std::ranges::count(open, 1) > 0 && newton.forces().internal.allFinite() ? open : Mask{};
}

void Run::refuse_volume_changes() {
  if (now.u.isZero(0) && now.v.isZero(0)) return;
  const Mask open = kept_volumes();
  if (open.empty()) return;
  const Elements& elements = equations.elements();
  if (!now.u.isZero(0)) refuse_change(*model.mesh, volume_change(elements, open, newton.tangent(), now.u), false);
  if (!now.v.isZero(0)) refuse_change(*model.mesh, volume_rate(elements, open, newton.tangent(), now.u, now.v), true);
}

void Run::begin_motion(const Step& step, const Supports& supports) {
  refuse_volume_changes();
  const Vector before = now.v;
  hold_start(supports);
  supports.set_off(now.time, step.dt, now.v);
  const Newton::Kept kept = newton.keep_volumes(now.u, now.v, before, supports);
  if (!kept.done)
    outcome.notes.emplace_back(
        "the start does not keep the volume of incompressible regions, and the supports let no motion do so: the first "
        "step takes that back");
  const auto note = [&](const char* what, double share) {
    if (share > noted_correction)
      outcome.notes.push_back(
          fmt::format("the initial {} is changed by up to {:.2g} of its largest value, so that incompressible regions "
                      "keep their volume on this mesh",
                      what, share));
  };
  note("displacement", kept.displacement);
  if (!before.isZero(0)) note(supports.moved.empty() ? "velocity" : "velocity (by moving supports too)", kept.velocity);
  settle_pressures();
}

void Run::jump_with_supports(const Step& step, const Supports& supports) {
  if (model.settings.integrator == Integrator::implicit_euler || kept_volumes().empty()) return;
  const Vector before = now.v;
  halt(supports);
  supports.set_off(now.time, step.dt, now.v);
  const double jump = (now.v - before).cwiseAbs().maxCoeff();
  const bool jumps = jump > seen_jump * std::max(before.cwiseAbs().maxCoeff(), now.v.cwiseAbs().maxCoeff());
  if (!jumps || !newton.keep_volumes(now.u, now.v, before, supports).done) {
    now.v = before;
    return;
  }
  Vector p;
  multiply(equations.mass(), Vector(now.v + before), p);
  now.energies.external_work += 0.5 * dot(Vector(now.v - before), p);
  outcome.notes.push_back(
      fmt::format("step '{}': its supports change speed at once, by up to {:.3g}, and incompressible regions with them",
                  step.name, jump));
}

void Run::begin_balance(const Step& step, const Supports& supports) {
  const ScaledLoads loads{{&equations.loads(now.step), 1.0, now.time}};
  Vector given = Vector::Zero(now.u.size());
  supports.set_off_rates(now.time, step.dt, given);
  bool balanced = true;
  now.a = newton.initial_acceleration(now.u, now.v, loads, supports, given, balanced);
  if (!balanced)
    outcome.notes.push_back(
        fmt::format("step '{}': the pressures of incompressible regions at its start are not determined: parts have no "
                    "mass, or supports hold more than volumes allow; accelerations there are without them",
                    step.name));
  acceleration_now = {};
  step_of_a = 0;
  set_reactions(newton.forces().residual(), supports);
}

bool Run::start_at_rest() {
  refuse_pushed_bodies();
  settle_pressures();
  now.load_factor = 0;
  newton.prepare(now.u, {});
  newton.rest();
  if (!sound_start()) return false;
  mark();
  return accept();
}

}  // namespace msml::fe
