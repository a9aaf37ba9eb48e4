// SPDX-License-Identifier: GPL-3.0-or-later
// What a condition may not say beside the elements, laws and solver of its scene.
#include <algorithm>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

bool zero(const Formula& formula) { return formula.constant() && formula.number == 0; }

void check_unknown(const Record& condition, bool scalar) {
  const std::string& tag = condition.tag();
  const bool of_scalar = tag == "fixedValue" || tag == "flux" || tag == "source";
  if (of_scalar && !scalar)
    refuse(condition, "is for scalar problems, whose regions have diffusionMaterial; this body has displacements");
  if (!of_scalar && scalar)
    refuse(condition,
           "is for displacements, but the regions have diffusionMaterial, whose unknown is a number; scalar problems "
           "take fixedValue, flux and source");
}

const Value* value_of(const Record& record, const std::string& attribute) {
  const int slot = record.description->find(attribute);
  return slot < 0 ? nullptr : &record.values[static_cast<std::size_t>(slot)];
}

/// True if the attribute `components`, where the tag has one, leaves the axis to itself.
bool leaves_out(const Record& record, int axis) {
  const Value* value = value_of(record, "components");
  const auto* words = value == nullptr ? nullptr : std::get_if<Words>(value);
  return words != nullptr && std::find(words->begin(), words->end(), std::string(1, "xyz"[axis])) == words->end();
}

void check_vectors(const Record& record, CellKind kind, const std::string& attribute, const Formulas& list) {
  if (list.size() % 3 != 0 || (attribute == "pressure" && list.size() != 3)) return;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const int axis = static_cast<int>(i % 3);
    if (axis < dimension(kind) || zero(list[i]) || leaves_out(record, axis)) continue;
    refuse(record, fmt::format("{}: entry {} = {} is along {}, but {} moves along {} alone; write 0 there", attribute,
                               i + 1, list[i].constant() ? fmt::format("{:g}", list[i].number) : list[i].text,
                               "xyz"[axis], dimension(kind) == 1 ? "a body of lines" : "a plane body",
                               dimension(kind) == 1 ? "x" : "x and y"));
  }
}

void check_spring(const Record& condition) {
  const Value *first = value_of(condition, "first"), *second = value_of(condition, "second");
  if (first == nullptr || second == nullptr) return;
  const auto *one = std::get_if<Integer>(first), *two = std::get_if<Integer>(second);
  if (one != nullptr && two != nullptr && *one == *two)
    refuse(condition, fmt::format("first and second are the same node, {}", *one));
}

void check_motion(const Record& condition, const fe::Settings& settings) {
  if (condition.tag() == "initialVelocity" && !fe::is_dynamic(settings.integrator))
    refuse(condition,
           fmt::format("has no meaning with timeIntegration=\"{}\", where nothing has inertia; leave it out, "
                       "or choose a dynamic timeIntegration",
                       fe::name(settings.integrator)));
  if (condition.tag() != "displacementConstraint" || !settings.arc_length.on) return;
  const auto* moved = std::get_if<Formulas>(value_of(condition, "displacement"));
  for (std::size_t i = 0; moved != nullptr && i < moved->size(); ++i)
    if (!zero((*moved)[i]) && !leaves_out(condition, static_cast<int>(i % 3)))
      refuse(condition,
             "moves supports, but arcLength follows loads alone: let the supports stay, or take arcLength=\"false\"");
}

}  // namespace

void check_condition(const Record& condition, const Surroundings& around) {
  if (around.scalar) check_unknown(condition, *around.scalar);
  const bool flat = around.kind != CellKind::vertex && dimension(around.kind) < 3;
  if (condition.tag() == "supportingMesh" && dimension(around.kind) != 3)
    refuse(condition, "needs a main mesh of tetrahedra");
  const auto& slots = condition.description->slots();
  for (std::size_t s = 0; s < slots.size() && flat; ++s)
    if (const auto* list = std::get_if<Formulas>(&condition.values[s]))
      check_vectors(condition, around.kind, slots[s].name, *list);
  check_spring(condition);
  if (around.settings != nullptr) check_motion(condition, *around.settings);
}

}  // namespace msml::simulation
