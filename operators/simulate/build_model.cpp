// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh, material, steps and conditions put together.
#include "operators/simulate/build_model.hpp"

#include <algorithm>

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

void note_gravity(const std::vector<const Record*>& steps, Reporter& reporter) {
  for (const Record* record : steps)
    if (const int slot = record->description->find("gravity");
        slot >= 0 && !record->given[static_cast<std::size_t>(slot)])
      reporter.note(fmt::format("{}: no gravity given, so it is (0, 0, -9.81) as in MSML", located(*record)));
}

}  // namespace

void check_gravity(const Record& step, bool scalar) {
  const int slot = step.description->find("gravity");
  if (!scalar || slot < 0 || !step.given[static_cast<std::size_t>(slot)]) return;
  const Formulas& gravity = step[Key<Formulas>{slot}];
  if (!std::all_of(gravity.begin(), gravity.end(), [](const Formula& g) { return g.constant() && g.number == 0; }))
    refuse(step,
           "gravity has no meaning where the unknown is a number (diffusionMaterial): leave it out, or take 0 0 0");
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
  for (const Record* step : all_of(args, "step")) check_gravity(*step, body.scalar);
  if (!body.scalar) note_gravity(all_of(args, "step"), reporter);
  add_conditions(object, body, reporter, model);
  return simulation;
}

}  // namespace msml::simulation
