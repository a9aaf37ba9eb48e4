// SPDX-License-Identifier: GPL-3.0-or-later
// The table of attributes that mean something beside certain others only.
#include "operators/simulate/idle_attributes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "msml/core/formula.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

/// What an attribute is looked at with.
struct Beside {
  const Record& record;  ///< its tag
  const fe::Settings& settings;
};

struct Need {
  const char *tag, *attribute;  ///< tag: "" any
  bool (*met)(const Beside&);
  const char* words;  ///< what it needs
};

bool dynamic(const Beside& b) { return fe::is_dynamic(b.settings.integrator); }
bool implicit(const Beside& b) { return !fe::is_explicit(b.settings.integrator); }
bool newmark(const Beside& b) { return b.settings.integrator == fe::Integrator::newmark; }
bool may_grow(const Beside& b) { return newmark(b) || !implicit(b); }
bool along_an_arc(const Beside& b) { return b.settings.arc_length.on; }
bool iterates(const Beside& b) {
  return implicit(b) && !along_an_arc(b) && b.settings.linear_solver != fe::LinearSolver::direct;
}
bool searches(const Beside& b) { return implicit(b) && !along_an_arc(b); }
bool repeats(const Beside& b) { return implicit(b) && b.settings.newton_iterations > 1; }
bool given(const Beside& b, const char* attribute) {
  return b.record.given[static_cast<std::size_t>(b.record.description->find(attribute))];
}
bool clamped(const Beside& b) { return text_of(b.record, "inversion") == "clamped"; }
bool ramps(const Beside& b) {
  const Record& record = b.record;
  const int table = record.description->find("table"), moved = record.description->find("displacement");
  const auto* list = std::get_if<Formulas>(&record.values[static_cast<std::size_t>(moved)]);
  const bool of_time = list != nullptr && std::ranges::any_of(*list, [](const Formula& formula) {
                         return !formula.constant() && examine(formula.text).of_time;
                       });
  return type(record.values[static_cast<std::size_t>(table)]) == Type::nothing && !of_time;
}

constexpr const char* implicit_words = "an implicit timeIntegration";
constexpr const char* repeating_words = "an implicit timeIntegration and newtonIterations above 1";
constexpr const char* searching_words = "an implicit timeIntegration without arcLength";
constexpr const char* dynamic_words = "a dynamic timeIntegration";

constexpr Need table[] = {
    {"solver", "beta", newmark, "timeIntegration=\"Newmark\""},
    {"solver", "gamma", newmark, "timeIntegration=\"Newmark\""},
    {"solver", "spectralRadius",
     [](const Beside& b) { return b.settings.integrator == fe::Integrator::generalized_alpha; },
     "timeIntegration=\"generalizedAlpha\""},
    {"solver", "mass", dynamic, dynamic_words},
    {"solver", "dampingRayleighRatioMass", dynamic, dynamic_words},
    {"solver", "dampingRayleighRatioStiffness", dynamic, dynamic_words},
    {"solver", "loadSteps", [](const Beside& b) { return b.settings.integrator == fe::Integrator::static_; },
     "timeIntegration=\"static\""},
    {"solver", "stepTolerance", [](const Beside& b) { return b.settings.adaptive_step && dynamic(b); },
     "adaptiveStep=\"true\" in implicit dynamics"},
    {"solver", "arcSteps", along_an_arc, "arcLength=\"true\""},
    {"solver", "largestLoadFactor", along_an_arc, "arcLength=\"true\""},
    {"solver", "largestDisplacement", along_an_arc, "arcLength=\"true\""},
    {"solver", "preconditioner", iterates, "a linearSolver that iterates"},
    {"solver", "linearSolver", searches,
     "an implicit timeIntegration without arcLength, which has a solver of its own"},
    {"solver", "newtonIterations", implicit, implicit_words},
    {"solver", "tolerance", repeats, repeating_words},
    {"solver", "lineSearch", [](const Beside& b) { return searches(b) && repeats(b); },
     "an implicit timeIntegration without arcLength, and newtonIterations above 1"},
    {"solver", "definiteness", searches, searching_words},
    {"solver", "untangle", implicit, implicit_words},
    {"solver", "allowUnstable", may_grow, "timeIntegration=\"Newmark\" or an explicit one"},
    {"linearElasticMaterial", "tangent", [](const Beside& b) { return text_of(b.record, "strain") != "small"; },
     "strain=\"corotated\""},
    {"", "clampedBelow", clamped, "inversion=\"clamped\""},
    {"", "damping", dynamic, dynamic_words},
    {"", "rayleighStiffnes", dynamic, dynamic_words},
    {"displacementConstraint", "ramp", ramps, "a displacement without a table and without t"},
    {"displacement", "timestep", [](const Beside& b) { return !given(b, "every"); }, "every to be absent, which wins"},
    {"probe", "count", [](const Beside& b) { return given(b, "along"); }, "along"}};

/// True if both are the same number, word or expression.
template <class... Types>
bool same(const Value& a, const Value& b) {
  return ((std::holds_alternative<Types>(a) && std::holds_alternative<Types>(b) &&
           std::get<Types>(a) == std::get<Types>(b)) ||
          ...);
}

/// True if the scene says something that is not what would hold anyway. Names of other programs are noted elsewhere.
bool said(const Record& record, std::size_t slot) {
  const Slot& described = record.description->slots()[slot];
  if (!record.given[slot] || same<double, Integer, std::string, Formula>(record.values[slot], described.fallback))
    return false;
  const auto* text = std::get_if<std::string>(&record.values[slot]);
  return described.name != "preconditioner" || text == nullptr || (*text != "none" && !of_other_program(*text));
}

/// Fields that are asked for although each of their values is known before.
void find_idle_fields(const Record& args, const Surroundings& around, const std::function<void(const Error&)>& tell) {
  Words asked;
  for (const char* attribute : {"field", "fields"})
    if (const int slot = args.description->find(attribute);
        slot >= 0 && args.description->category() == "output" && args.given[static_cast<std::size_t>(slot)]) {
      const Value& value = args.values[static_cast<std::size_t>(slot)];
      if (const auto* list = std::get_if<Words>(&value)) asked = *list;
      if (const auto* one = std::get_if<std::string>(&value)) asked = {*one};
    }
  for (const std::string& field : asked) {
    if ((field == "velocity" || field == "acceleration") && !fe::is_dynamic(around.settings->integrator))
      tell(Error(fmt::format("{}: {} is 0 with timeIntegration=\"{}\". Leave it out", args.tag(), field,
                             fe::name(around.settings->integrator)),
                 args.where));
    if (field.starts_with("fiberStretch") && around.fibres == false && around.scalar == false)
      tell(
          Error(fmt::format("{}: {} is 1, since no material has fibres. Leave it out", args.tag(), field), args.where));
  }
}

}  // namespace

void find_idle(const Record& args, const Surroundings& around, const std::function<void(const Error&)>& tell) {
  for (const Need& need : table) {
    const int slot = need.tag == args.tag() || *need.tag == '\0' ? args.description->find(need.attribute) : -1;
    if (slot >= 0 && said(args, static_cast<std::size_t>(slot)) && !need.met({args, *around.settings}))
      tell(Error(
          fmt::format("{}: {} means nothing here: it needs {}. Leave it out", args.tag(), need.attribute, need.words),
          args.where));
  }
  find_idle_fields(args, around, tell);
  if (args.tag() == "mass" && around.scalar == true)
    tell(Error("mass: it means nothing beside diffusionMaterial, whose problem is stationary. Leave it out",
               args.where));
  for (const Record& child : args.children) find_idle(child, around, tell);
}

}  // namespace msml::simulation
