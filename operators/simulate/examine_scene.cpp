// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of an object that need no mesh.
#include "operators/simulate/examine_scene.hpp"

#include <algorithm>
#include <memory>

#include "msml/core/silent_reporter.hpp"
#include "operators/simulate/build_model.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/varying_record.hpp"
#include "solver/combinations.hpp"
#include "solver/materials/fibres.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

using Report = std::function<void(const Error&)>;
using LawPtr = std::shared_ptr<const fe::Law>;

bool varies(const Value& value) {
  const auto changes = [](const Formula& formula) { return !formula.constant(); };
  const auto* formula = std::get_if<Formula>(&value);
  const auto* list = std::get_if<Formulas>(&value);
  return (formula != nullptr && changes(*formula)) || (list != nullptr && std::ranges::any_of(*list, changes));
}

/// A direction that names a field of the mesh.
bool named_direction(const Slot& slot, const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return slot.unit == "direction" && text != nullptr && fe::direction_numbers(*text).empty();
}

/// False where an attribute is not known yet: it comes from another task, or differs from place to place.
bool complete(const Record& record) {
  const auto& slots = record.description->slots();
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (varies(record.values[i]) || named_direction(slots[i], record.values[i]) ||
        (slots[i].required && type(record.values[i]) == Type::nothing))
      return false;
  const std::string& category = record.description->category();
  return text_of(record, "fields").empty() || (category != "material" && category != "prony");
}

/// Hands what `check` throws to `fault`, at the place of the record where it has none of its own.
template <class Check>
void attempt(const Record& record, const Report& fault, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    fault(Error(error.what(), error.where().line > 0 ? error.where() : record.where, error.failure()));
  }
}

/// A region as far as it is known, and the tags it comes from.
struct Part {
  fe::Region region;
  const Record* material = nullptr;
  const Record* prony = nullptr;
};

/// What the object and the solver say, as a model without a mesh.
struct Outline {
  fe::Model model;
  CellKind kind = CellKind::vertex;
  std::vector<Part> parts;
};

Part part_of(const Record& record, std::size_t position, bool particles, const Report& fault) {
  Part part{.region = {.name = region_name(record, position), .law = nullptr},
            .material = first_of(record, "material"),
            .prony = first_of(record, "prony")};
  if (part.prony != nullptr)
    attempt(*part.prony, fault, [&] {
      VaryingRecord::check(*part.prony);
      if (complete(*part.prony)) part.region.prony = make<fe::Prony>(*part.prony);
    });
  if (part.material == nullptr) return part;
  const Record& material = *part.material;
  attempt(material, fault, [&] {
    check_material(material, particles);
    VaryingRecord::check(material);
    if (material.tag() != "pointMass" && complete(material)) part.region.law = make<LawPtr>(material);
  });
  if (const Record* mass = first_of(record, "mass")) attempt(*mass, fault, [&] { VaryingRecord::check(*mass); });
  return part;
}

void read_settings(const Record& args, const Report& fault, fe::Model& model) {
  const Record* solver = first_of(args, "solver");
  if (solver == nullptr || !complete(*solver)) return;
  attempt(*solver, fault, [&] {
    SilentReporter silent;
    model.settings = make<SettingsBuilder>(*solver)(silent, 1);
    fe::check_settings(model.settings);
  });
}

Outline outline_of(const Record& args, const Report& fault) {
  Outline outline;
  fe::Model& model = outline.model;
  const Record* mesh = first_of(args, "mesh");
  if (mesh != nullptr) {
    const MeshChoice words = words_of_mesh(*mesh);
    outline.kind = words.kind;
    model.formulation = words.formulation;
    model.quadrature = words.quadrature;
    model.plane = words.plane;
  }
  read_settings(args, fault, model);
  const auto records = all_of(args, "region");
  for (std::size_t i = 0; i < records.size(); ++i) {
    outline.parts.push_back(part_of(*records[i], i, mesh != nullptr && outline.kind == CellKind::vertex, fault));
    model.regions.push_back(outline.parts.back().region);
  }
  return outline;
}

void examine_combinations(const Record& args, const Outline& outline, const Report& fault) {
  const fe::Model& model = outline.model;
  if (const Record* mesh = first_of(args, "mesh"))
    attempt(*mesh, fault, [&] { fe::check_elements(model, outline.kind); });
  for (const Part& part : outline.parts) {
    if (part.material != nullptr) attempt(*part.material, fault, [&] { fe::check_law(model, part.region); });
    if (part.prony != nullptr) attempt(*part.prony, fault, [&] { fe::check_prony(model, part.region); });
  }
  const Record* solver = first_of(args, "solver");
  attempt(solver != nullptr ? *solver : args, fault, [&] { fe::check_problem(model); });
}

/// Conditions against the elements, the laws and the solver, as far as these are known.
void examine_conditions(const Record& args, const Outline& outline, const Report& fault) {
  const auto known = std::find_if(outline.parts.begin(), outline.parts.end(),
                                  [](const Part& part) { return part.region.law != nullptr; });
  Surroundings around{.kind = outline.kind, .settings = &outline.model.settings};
  if (known != outline.parts.end()) around.scalar = known->region.law->components() == 1;
  for (const Record* condition : all_of(args, "constraint"))
    attempt(*condition, fault, [&] { check_condition(*condition, around); });
  for (const Record* step : all_of(args, "step"))
    attempt(*step, fault, [&] { check_gravity(*step, around.scalar.value_or(false), outline.kind); });
}

/// A damper somewhere: forward Euler lives on them.
bool damps(const Record& args) {
  for (const Record* condition : all_of(args, "constraint"))
    for (const char* attribute : {"damping", "rayleighStiffnes"})
      if (const int slot = condition->description->find(attribute); slot >= 0)
        if (const auto* value = std::get_if<Formula>(&condition->values[static_cast<std::size_t>(slot)]))
          if (!value->constant() || value->number > 0) return true;
  return false;
}

void examine_forward_euler(const Record& args, const Outline& outline, const Report& fault) {
  const fe::Settings& s = outline.model.settings;
  const Record* solver = first_of(args, "solver");
  if (s.integrator != fe::Integrator::forward_euler || s.allow_unstable || solver == nullptr) return;
  if (s.damping_mass > 0 || s.damping_stiffness > 0 || outline.kind == CellKind::vertex || damps(args)) return;
  attempt(*solver, fault, [&] {
    refuse(*solver,
           "forwardEuler is unstable at any dt without damping: give dampingRayleighRatioMass or "
           "dampingRayleighRatioStiffness, take symplecticEuler or an implicit timeIntegration, or "
           "allowUnstable=\"true\"");
  });
}

}  // namespace

void examine_scene(const Record& args, const Report& fault) {
  const Outline outline = outline_of(args, fault);
  examine_combinations(args, outline, fault);
  examine_conditions(args, outline, fault);
  examine_forward_euler(args, outline, fault);
  for (const Record* record : all_of(args, "output"))
    if (complete(*record)) attempt(*record, fault, [&] { make<OutputRequest>(*record); });
}

}  // namespace msml::simulation
