// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of an object that need no mesh.
#include "operators/simulate/examine_scene.hpp"

#include <algorithm>
#include <memory>

#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

using Report = std::function<void(const Error&)>;
using LawPtr = std::shared_ptr<const fe::Law>;

class Silent final : public Reporter {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string&) override {}
  void warn(const std::string&) override {}
  void print(const std::string&) override {}
  void record(const std::string&, const std::string&) override {}
};

/// False where an attribute is not known yet: it comes from another task, or differs from place to place.
bool complete(const Record& record) {
  const auto& slots = record.description->slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].required && type(record.values[i]) == Type::nothing) return false;
    const auto* formula = std::get_if<Formula>(&record.values[i]);
    if (formula && !formula->constant()) return false;
  }
  return true;
}

/// What the tag builds, or nothing after its fault has been reported at its place.
template <class Result>
std::optional<Result> attempt(const Record& record, const Report& fault) {
  try {
    return make<Result>(record);
  } catch (const Error& error) {
    fault(Error(error.what(), error.where().line > 0 ? error.where() : record.where, error.failure()));
    return std::nullopt;
  }
}

struct Material {
  const Record* record;
  LawPtr law;
};

std::vector<Material> materials(const Record& args, const Report& fault) {
  std::vector<Material> found;
  for (const Record* record : all_of(args, "material"))
    if (complete(*record) && record->tag() != "pointMass")
      if (const auto law = attempt<LawPtr>(*record, fault)) found.push_back({record, *law});
  return found;
}

/// Laws that do not go with the formulation of the elements, at the place of the material.
void examine_formulation(const Record& args, const std::vector<Material>& found, const Report& fault) {
  const Record* mesh = first_of(args, "mesh");
  if (!mesh) return;
  fe::Model model;
  model.formulation = formulation_named(text_of(*mesh, "formulation"));
  for (const Material& material : found) try {
      check_law(model, {.name = material.record->tag(), .law = material.law});
    } catch (const Error& error) {
      fault(Error(error.what(), material.record->where));
    }
}

}  // namespace

void examine_scene(const Record& args, const Report& fault) {
  Silent silent;
  examine_formulation(args, materials(args, fault), fault);
  for (const Record* record : all_of(args, "output"))
    if (complete(*record)) attempt<OutputRequest>(*record, fault);
  if (const Record* solver = first_of(args, "solver"))
    if (const auto settings = attempt<SettingsBuilder>(*solver, fault)) try {
        (*settings)(silent, 1);
      } catch (const Error& error) {
        fault(error);
      }
}

}  // namespace msml::simulation
