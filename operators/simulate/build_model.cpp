// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh, material, steps and conditions put together.
#include "operators/simulate/build_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "operators/simulate/check_output.hpp"
#include "operators/simulate/records.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

const Record& required(const Record& root, const std::string& category) {
  const Record* found = first_of(root, category);
  if (found == nullptr) throw Error(fmt::format("the object has no {}", category), root.where);
  return *found;
}

std::vector<fe::Step> build_steps(const Record& args) {
  std::vector<fe::Step> steps;
  for (const Record* record : all_of(args, "step")) {
    steps.push_back(make<fe::Step>(*record));
    if (steps.back().name.empty()) steps.back().name = fmt::format("step{}", steps.size());
  }
  if (steps.empty()) throw Error("the simulation has no step", args.where);
  return steps;
}

void note_gravity(const std::vector<const Record*>& steps, CellKind kind, Reporter& reporter) {
  const bool felt = kind == CellKind::vertex || dimension(kind) == 3;
  for (const Record* record : steps)
    if (const int slot = record->description->find("gravity");
        slot >= 0 && !record->given[static_cast<std::size_t>(slot)])
      reporter.note(fmt::format("{}: no gravity given, so it is (0, 0, -9.81) as in MSML{}", located(*record),
                                felt ? "" : ", which a body that does not move along z does not feel"));
}

/// Time matters to viscoelastic regions, in statics too.
void tell_of_time(const fe::Model& model, Reporter& reporter) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const fe::Region& region : model.regions)
    for (const double tau : region.prony.tau) shortest = std::min(shortest, tau);
  if (!std::isfinite(shortest)) return;
  const bool parts = model.settings.integrator == fe::Integrator::static_;
  for (const fe::Step& step : model.steps) {
    const double dt = parts ? step.dt * step.count / model.settings.load_steps : step.dt;
    if (parts)
      reporter.note(
          fmt::format("step '{}': prony relaxes over dt * iterations = {:g}, in which the loads grow in {} of {:g}",
                      step.name, step.dt * step.count, counted(model.settings.load_steps, "part"), dt));
    if (dt > shortest && !(model.settings.adaptive_step && !fe::is_dynamic(model.settings.integrator)))
      reporter.warn(fmt::format(
          "step '{}': its time steps of {:g} are longer than the shortest tau of prony, {:g}: what happens "
          "inside of a step is taken as linear in time. Take {}",
          step.name, dt, shortest, parts ? "more loadSteps, or timeIntegration = \"quasiStatic\"" : "a smaller dt"));
  }
}

/// Refuses requests that have no meaning; of the fields that a scene leaves to the defaults, those are dropped.
void check_requests(const Record& object, Simulation& simulation) {
  const Surroundings around{.kind = simulation.body.kind,
                            .scalar = simulation.body.scalar,
                            .mixed = simulation.model.formulation == fe::Formulation::mixed};
  for (const Record* record : all_of(object, "output")) check_output(*record, around);
  for (OutputRequest& request : simulation.outputs)
    std::erase_if(request.fields, [&](const std::string& field) { return !has_meaning(field, around); });
}

bool wants_energy(const OutputRequest& output) {
  return output.kind == OutputKind::energies ||
         std::any_of(output.fields.begin(), output.fields.end(),
                     [](const std::string& field) { return field.starts_with("energyDensity"); });
}

}  // namespace

void check_gravity(const Record& step, bool scalar, CellKind kind, const fe::Tell& tell) {
  const int slot = step.description->find("gravity");
  if (slot < 0 || !step.given[static_cast<std::size_t>(slot)]) return;
  const Formulas& gravity = step[Key<Formulas>{slot}];
  const auto zero = [](const Formula& g) { return g.constant() && g.number == 0; };
  if (scalar && !std::all_of(gravity.begin(), gravity.end(), zero))
    return tell(fault_of(
        step, "gravity has no meaning where the unknown is a number (diffusionMaterial): leave it out, or take 0 0 0"));
  const int axes = kind == CellKind::vertex ? 3 : dimension(kind);
  for (std::size_t k = static_cast<std::size_t>(axes); k < gravity.size(); ++k)
    if (!zero(gravity[k]))
      tell(fault_of(step,
                    fmt::format("gravity has a part along {}, but {}: write 0 there", "xyz"[k],
                                axes == 1 ? "lines move along x alone" : "plane bodies move along x and y alone")));
}

Simulation build_model(const Record& args, Reporter& reporter, int threads) {
  const Record* found = first_of(args, "object");
  const Record& object = found != nullptr ? *found : args;
  Simulation simulation{.name = object.id.empty() ? "object" : object.id, .where = object.where};
  for (const Record* record : all_of(object, "output")) simulation.outputs.push_back(make<OutputRequest>(*record));
  const MeshChoice choice = make<MeshChoice>(required(object, "mesh"));
  simulation.body = make_body(choice.mesh, choice.kind);
  Body& body = simulation.body;
  fe::Model& model = simulation.model;
  model.mesh = body.mesh;
  model.formulation = choice.formulation;
  model.quadrature = choice.quadrature;
  model.plane = choice.plane;
  model.thickness = choice.thickness;
  if (body.kind == CellKind::vertex)
    model.point_masses = build_masses(all_of(object, "region"), body, reporter);
  else
    model.regions = build_regions(all_of(object, "region"), body, reporter);
  body.small_strain = !model.regions.empty() &&
                      std::all_of(model.regions.begin(), model.regions.end(),
                                  [](const fe::Region& region) { return region.law && region.law->small_strain(); });
  body.scalar = fe::is_scalar(model);
  model.settings = make<SettingsBuilder>(required(args, "solver"))(reporter, threads);
  model.steps = build_steps(args);
  for (const Record* step : all_of(args, "step")) check_gravity(*step, body.scalar, body.kind);
  check_requests(object, simulation);
  if (!body.scalar) note_gravity(all_of(args, "step"), body.kind, reporter);
  add_conditions(object, body, reporter, model);
  tell_of_time(model, reporter);
  model.stored_energies = std::any_of(simulation.outputs.begin(), simulation.outputs.end(), wants_energy);
  return simulation;
}

}  // namespace msml::simulation
