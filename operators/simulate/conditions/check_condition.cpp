// SPDX-License-Identifier: GPL-3.0-or-later
// What a condition may not say beside the elements, laws and solver of its scene.
#include <fmt/ranges.h>

#include <algorithm>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

bool zero(const Formula& formula) { return formula.constant() && formula.number == 0; }

/// False where it is told.
bool fits_unknown(const Record& condition, bool scalar, const fe::Tell& tell) {
  const std::string& tag = condition.tag();
  const bool of_scalar = tag == "fixedValue" || tag == "flux" || tag == "source";
  if (of_scalar && !scalar)
    tell(fault_of(condition,
                  "is for scalar problems, whose regions have diffusionMaterial; this body has displacements"));
  if (!of_scalar && scalar)
    tell(fault_of(condition,
                  "is for displacements, but the regions have diffusionMaterial, whose unknown is a number; scalar "
                  "problems take fixedValue, flux and source"));
  return of_scalar == scalar;
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

/// What an axis across a body of lines or triangles is told.
Error across(const Record& record, CellKind kind, const std::string& attribute, std::size_t i,
             const std::string& value) {
  return fault_of(
      record, fmt::format("{}: entry {} = {} is along {}, but {} moves along {} alone; write 0 there", attribute, i + 1,
                          value, "xyz"[i % 3], dimension(kind) == 1 ? "a body of lines" : "a plane body",
                          dimension(kind) == 1 ? "x" : "x and y"));
}

void check_normal(const Record& record, CellKind kind, const fe::Tell& tell) {
  const Value* value = value_of(record, "normal");
  const auto* normal = value == nullptr ? nullptr : std::get_if<std::vector<double>>(value);
  for (std::size_t i = static_cast<std::size_t>(dimension(kind)); normal != nullptr && i < normal->size(); ++i)
    if ((*normal)[i] != 0) tell(across(record, kind, "normal", i, fmt::format("{:g}", (*normal)[i])));
}

/// Some of the named axes must be ones that the body moves along.
void check_components(const Record& record, CellKind kind, const fe::Tell& tell) {
  const Value* value = value_of(record, "components");
  const auto* words = value == nullptr ? nullptr : std::get_if<Words>(value);
  if (words == nullptr || words->empty()) return;
  for (int axis = 0; axis < dimension(kind); ++axis)
    if (!leaves_out(record, axis)) return;
  tell(fault_of(record, fmt::format("components = {} holds nothing: {} moves along {} alone", fmt::join(*words, " "),
                                    dimension(kind) == 1 ? "a body of lines" : "a plane body",
                                    dimension(kind) == 1 ? "x" : "x and y")));
}

/// The first entry along each axis that it does not move along.
void check_vectors(const Record& record, CellKind kind, const std::string& attribute, const Formulas& list,
                   const fe::Tell& tell) {
  if (list.size() % 3 != 0 || (attribute == "pressure" && list.size() != 3)) return;
  bool told[3] = {};
  for (std::size_t i = 0; i < list.size(); ++i) {
    const int axis = static_cast<int>(i % 3);
    if (told[axis] || axis < dimension(kind) || zero(list[i]) || leaves_out(record, axis)) continue;
    tell(across(record, kind, attribute, i, list[i].constant() ? fmt::format("{:g}", list[i].number) : list[i].text));
    told[axis] = true;
  }
}

void check_pressure(const Record& condition, const fe::Tell& tell) {
  const Value* pressure = value_of(condition, "pressure");
  const Value* follower = value_of(condition, "follower");
  if (pressure == nullptr || follower == nullptr) return;
  const auto* numbers = std::get_if<Formulas>(pressure);
  const auto* wanted = std::get_if<bool>(follower);
  if (numbers != nullptr && numbers->size() == 3 && wanted != nullptr && *wanted)
    tell(fault_of(condition,
                  "follower = true has no meaning for a traction vector (three numbers), which keeps its direction"));
}

void check_spring(const Record& condition, const fe::Tell& tell) {
  const Value *first = value_of(condition, "first"), *second = value_of(condition, "second");
  if (first == nullptr || second == nullptr) return;
  const auto *one = std::get_if<Integer>(first), *two = std::get_if<Integer>(second);
  if (one != nullptr && two != nullptr && *one == *two)
    tell(fault_of(condition, fmt::format("first and second are the same node, {}", *one)));
}

void check_motion(const Record& condition, const fe::Settings& settings, const fe::Tell& tell) {
  if (condition.tag() == "initialVelocity" && !fe::is_dynamic(settings.integrator))
    tell(fault_of(condition,
                  fmt::format("has no meaning with timeIntegration=\"{}\", where nothing has inertia; leave it out, "
                              "or choose a dynamic timeIntegration",
                              fe::name(settings.integrator))));
  if (settings.arc_length.on && settings.integrator == fe::Integrator::static_) check_along_an_arc(condition, tell);
}

/// False where it is told.
bool fits_particles(const Record& condition, const fe::Tell& tell) {
  const std::string& tag = condition.tag();
  if (tag != "bodyForce" && tag != "surfaceTraction" && !tag.starts_with("surfacePressure")) return true;
  tell(fault_of(condition,
                "acts on elements, which particles do not have; take forceConstraint, or the gravity of a step"));
  return false;
}

void check_across(const Record& condition, CellKind kind, const fe::Tell& tell) {
  const auto& slots = condition.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s)
    if (const auto* list = std::get_if<Formulas>(&condition.values[s]))
      check_vectors(condition, kind, slots[s].name, *list, tell);
  check_normal(condition, kind, tell);
  check_components(condition, kind, tell);
}

}  // namespace

void check_condition(const Record& condition, const Surroundings& around, const fe::Tell& tell) {
  // What is meant for another problem has one fault; the others would only follow from it.
  if (around.kind == CellKind::vertex && !fits_particles(condition, tell)) return;
  if (around.scalar && !fits_unknown(condition, *around.scalar, tell)) return;
  if (around.kind && condition.tag() == "supportingMesh" && dimension(*around.kind) != 3)
    tell(fault_of(condition, "needs a main mesh of tetrahedra"));
  if (around.kind && *around.kind != CellKind::vertex && dimension(*around.kind) < 3)
    check_across(condition, *around.kind, tell);
  check_pressure(condition, tell);
  check_spring(condition, tell);
  if (around.settings != nullptr) check_motion(condition, *around.settings, tell);
}

}  // namespace msml::simulation
