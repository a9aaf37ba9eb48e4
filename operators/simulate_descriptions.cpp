// SPDX-License-Identifier: GPL-3.0-or-later
// The tags inside a scene: mesh kinds, materials, constraints, loads, solver, steps and output requests.
#include "msml/core/registry.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/settings.hpp"
#include "solver/registry.hpp"

namespace msml::operators {

void add_scene_descriptions(Registry& registry);

namespace {

template <class T>
void add(Registry& registry, const T& description) {
  registry.add(std::shared_ptr<const Description>(std::make_shared<const T>(description)));
}

}  // namespace

void add_scene_descriptions(Registry& registry) {
  for (const auto& kind : simulation::mesh_kinds()) add(registry, kind);
  fe::describe_materials(registry);
  add(registry, simulation::mass());
  add(registry, simulation::point_mass());
  add(registry, simulation::prony());
  for (const auto& condition : simulation::conditions()) add(registry, condition);
  for (const auto& output : simulation::outputs()) add(registry, output);
  add(registry, simulation::solver());
  add(registry, simulation::step());
  for (const Description& tag : simulation::future_tags())
    if (registry.find(tag.tag(), {tag.category()}) == nullptr) add(registry, tag);
}

}  // namespace msml::operators
