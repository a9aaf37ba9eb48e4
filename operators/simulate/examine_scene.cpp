// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of an object that need no mesh.
#include "operators/simulate/examine_scene.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "msml/core/faults.hpp"
#include "msml/core/silent_reporter.hpp"
#include "operators/simulate/build_model.hpp"
#include "operators/simulate/check_output.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/fillings.hpp"
#include "operators/simulate/idle_attributes.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/varying_record.hpp"
#include "solver/combinations.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

using Report = std::function<void(const Error&)>;
using LawPtr = std::shared_ptr<const fe::Law>;

/// Puts faults without a place of their own at the place of the record.
Report at(const Record& record, const Report& fault) {
  return [&](const Error& error) {
    fault(Error(error.what(), error.where().line > 0 ? error.where() : record.where, error.failure()));
  };
}

/// Hands what `check` throws to `fault`, each line by itself.
template <class Check>
void attempt(const Record& record, const Report& fault, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    for (const Error& line : lines_of(error)) at(record, fault)(line);
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
  bool settings = false;  ///< those of the model are known
  std::optional<CellKind> kind = {};
  std::vector<Part> parts;
};

/// What keeps a law from being built goes to `of_law`.
Part part_of(const Record& record, std::size_t position, std::optional<CellKind> kind, const Report& fault,
             const Report& of_law) {
  Part part{.region = {.name = region_name(record, position), .law = nullptr},
            .material = first_of(record, "material"),
            .prony = first_of(record, "prony")};
  if (part.prony != nullptr) part.region.prony = {{0.5}, {1}};  // where it cannot be made
  if (part.prony != nullptr && complete(*part.prony))
    attempt(*part.prony, fault, [&] { part.region.prony = make<fe::Prony>(*part.prony); });
  attempt(record, fault, [&] { check_region_indices(record); });
  if (kind && part.material != nullptr)
    attempt(*part.material, fault, [&] { check_material(*part.material, kind == CellKind::vertex); });
  for (const char* category : {"mass", "prony"})
    if (const Record* beside = first_of(record, category); beside != nullptr && kind == CellKind::vertex)
      attempt(*beside, fault, [&] { refuse(*beside, "has no meaning for particles; their pointMass says it"); });
  if (part.material == nullptr || part.material->tag() == "pointMass" || !complete(*part.material)) return part;
  attempt(*part.material, of_law, [&] { part.region.law = make<LawPtr>(*part.material); });
  return part;
}

void read_settings(const Record& args, const Report& fault, Outline& outline) {
  const Record* solver = first_of(args, "solver");
  if (solver == nullptr || !complete(*solver)) return;
  attempt(*solver, fault, [&] {
    SilentReporter silent;
    outline.model.settings = make<SettingsBuilder>(*solver)(silent, 1);
    outline.settings = true;
  });
  if (outline.settings) fe::check_settings(outline.model.settings, at(*solver, fault));
}

Outline outline_of(const Record& args, const Report& fault, const Report& of_law) {
  Outline outline;
  fe::Model& model = outline.model;
  if (const Record* mesh = first_of(args, "mesh")) {
    const MeshChoice words = words_of_mesh(*mesh);
    outline.kind = words.kind;
    model.formulation = words.formulation;
    model.quadrature = words.quadrature;
    model.plane = words.plane;
    attempt(*mesh, fault, [&] { check_mesh(*mesh); });
  }
  read_settings(args, fault, outline);
  const auto records = all_of(args, "region");
  for (std::size_t i = 0; i < records.size(); ++i) {
    outline.parts.push_back(part_of(*records[i], i, outline.kind, fault, of_law));
    model.regions.push_back(outline.parts.back().region);
  }
  return outline;
}

Surroundings surroundings_of(const Outline& outline) {
  const fe::Model& model = outline.model;
  Surroundings around{.kind = outline.kind,
                      .mixed = model.formulation == fe::Formulation::mixed,
                      .one_region = outline.parts.size() == 1,
                      .settings = outline.settings ? &model.settings : nullptr};
  bool every = !outline.parts.empty(), fibres = false;
  for (const Part& part : outline.parts) {
    every = every && part.material != nullptr;
    if (part.material == nullptr) continue;
    if (!around.scalar) around.scalar = part.material->tag() == "diffusionMaterial";
    fibres = fibres || part.material->description->find("fiber") >= 0;
    around.incompressible = around.incompressible || (part.region.law != nullptr && part.region.law->incompressible());
  }
  if (every) around.fibres = fibres;
  if (outline.kind == CellKind::vertex) around.scalar = false;
  return around;
}

void examine_combinations(const Record& args, const Outline& outline, const Report& fault) {
  const fe::Model& model = outline.model;
  if (const Record* mesh = first_of(args, "mesh")) fe::check_elements(model, *outline.kind, at(*mesh, fault));
  const auto first = std::ranges::find_if(outline.parts, [](const Part& part) { return part.region.law != nullptr; });
  for (const Part& part : outline.parts) {
    if (part.prony != nullptr) fe::check_prony(model, part.region, at(*part.prony, fault));
    if (part.region.law == nullptr) continue;
    fe::check_law(model, part.region, at(*part.material, fault));
    fe::check_same_unknown(first->region, part.region, at(*part.material, fault));
  }
  const Record* solver = first_of(args, "solver");
  if (solver == nullptr || !outline.settings) return;
  fe::check_problem(model, at(*solver, fault));
  attempt(*solver, fault, [&] { check_mass_matrix(*solver, model.settings); });
  if (outline.kind) fe::check_preconditioner(model, *outline.kind, at(*solver, fault));
}

/// Conditions against the elements, the laws and the solver, as far as these are known.
void examine_conditions(const Record& args, const Surroundings& around, const Report& fault) {
  std::map<std::string, int> counts;
  for (const Record* condition : all_of(args, "constraint")) ++counts[condition->tag()];
  const std::vector<std::string> steps = step_names(args);
  for (const Record* step : all_of(args, "step"))
    if (around.kind) check_gravity(*step, around.scalar.value_or(false), *around.kind, fault);
  for (const Placed& placed : placed_conditions(args)) {
    const Record& condition = *placed.record;
    check_condition(condition, around, fault);
    check_counts(condition, fault);
    attempt(condition, fault, [&] { check_volumes(condition, around, counts[condition.tag()] == 1); });
    attempt(condition, fault, [&] { check_steps(placed, steps); });
  }
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
  if (!outline.settings || s.integrator != fe::Integrator::forward_euler || s.allow_unstable || solver == nullptr)
    return;
  if (s.damping_mass > 0 || s.damping_stiffness > 0 || outline.kind == CellKind::vertex || damps(args)) return;
  attempt(*solver, fault, [&] {
    refuse(*solver,
           "forwardEuler is unstable at any dt without damping: give dampingRayleighRatioMass or "
           "dampingRayleighRatioStiffness, take symplecticEuler or an implicit timeIntegration, or "
           "allowUnstable=\"true\"");
  });
}

void examine_outputs(const Record& args, const Surroundings& around, const Report& fault) {
  for (const Record* record : all_of(args, "output")) {
    Record request = *record;
    request.values[static_cast<std::size_t>(record->description->find("id"))] = std::string("x");  // judged elsewhere
    if (complete(request)) attempt(*record, fault, [&] { make<OutputRequest>(request); });
    check_output(*record, around, fault);
  }
}

/// Methods that damp no motion let the pressures swing that keep volumes at the ends of steps.
void examine_pressures(const Record& args, const Surroundings& around, const Report& warn) {
  const Record* solver = first_of(args, "solver");
  if (!around.incompressible || around.settings == nullptr || solver == nullptr) return;
  const fe::Settings& s = *around.settings;
  const bool newmark = s.integrator == fe::Integrator::newmark && s.newmark_gamma <= 0.5;
  const bool alpha = s.integrator == fe::Integrator::generalized_alpha && s.spectral_radius == 1;
  if (newmark || alpha)
    warn(fault_of(*solver,
                  fmt::format("{} lets the pressure of incompressible=\"true\" swing from step to step, the more the "
                              "longer it runs, since it damps nothing. Take {} or dynamicImplicitEuler, which damp it",
                              newmark ? "timeIntegration=\"Newmark\"" : "spectralRadius=\"1\"",
                              newmark ? "generalizedAlpha" : "a smaller one")));
}

enum class Kind : std::uint8_t { fault, fault_of_law, warning };

/// One thing that is wrong, or that may well be.
struct Finding {
  Error error;
  Kind kind;
  int line() const { return error.where().line; }
  bool operator<(const Finding& other) const {
    return std::pair(line(), std::string(error.what())) < std::pair(other.line(), std::string(other.error.what()));
  }
};

/// All that is found in a record in which nothing is open.
std::vector<Finding> examine_filled(const Record& args, bool every_tag) {
  std::vector<Finding> found;
  const Report fault = [&](const Error& error) { found.push_back({error, Kind::fault}); };
  const Report of_law = [&](const Error& error) { found.push_back({error, Kind::fault_of_law}); };
  const Outline outline = outline_of(args, fault, of_law);
  const Surroundings around = surroundings_of(outline);
  examine_combinations(args, outline, fault);
  examine_conditions(args, around, fault);
  examine_outputs(args, around, fault);
  if (every_tag) {
    examine_forward_euler(args, outline, fault);
    check_arc_loads(args, around, fault);
    check_held(args, around, fault);
  }
  const Report warn = [&](const Error& error) { found.push_back({error, Kind::warning}); };
  if (outline.settings) find_idle(args, around, warn);
  find_idle_tables(args, warn);
  examine_pressures(args, around, warn);
  return found;
}

/// What is found with every filling. Where a law refuses the very numbers that a filling has, which few others have, it
/// may be about to refuse what it refuses with the others.
std::vector<Finding> certain(const std::vector<std::vector<Finding>>& fillings) {
  std::map<Finding, std::size_t> counts;
  for (const auto& filling : fillings)
    for (const Finding& one : std::set<Finding>(filling.begin(), filling.end())) ++counts[one];
  const auto rare = [&](const Finding& one) { return 3 * counts[one] < fillings.size(); };
  std::vector<Finding> kept;
  for (const auto& entry : counts) {
    const Finding& one = entry.first;
    const auto agrees = [&](const std::vector<Finding>& filling) {
      return std::ranges::any_of(filling, [&](const Finding& other) {
        const bool same = !(one < other) && !(other < one);
        const bool laws = one.kind == Kind::fault_of_law && other.kind == Kind::fault_of_law;
        return same || (laws && other.line() == one.line() && rare(other));
      });
    };
    if (!rare(one) && std::ranges::all_of(fillings, agrees)) kept.push_back(one);
  }
  return kept;
}

/// What expressions and fields may say, whatever they are worked out to be.
void examine_expressions(const Record& args, const Report& fault) {
  for (const char* category : {"material", "mass", "prony"})
    for (const Record* record : all_of(args, category))
      attempt(*record, fault, [&] { VaryingRecord::check(*record, fault); });
}

}  // namespace

void examine_scene(const Examination& scene) {
  examine_expressions(scene.args, scene.fault);
  const Fillings fillings(scene.args);
  std::vector<std::vector<Finding>> found;
  do {
    found.push_back(examine_filled(fillings.at(static_cast<int>(found.size())), scene.every_tag));
  } while (!found.front().empty() && static_cast<int>(found.size()) < fillings.count());
  for (const Finding& one : certain(found)) (one.kind == Kind::warning ? scene.warn : scene.fault)(one.error);
}

}  // namespace msml::simulation
