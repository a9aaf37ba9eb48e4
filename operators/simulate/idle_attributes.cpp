// SPDX-License-Identifier: GPL-3.0-or-later
// The table of attributes that mean something beside certain others only.
#include "operators/simulate/idle_attributes.hpp"

#include <fmt/format.h>

#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

/// What an attribute is looked at with.
struct Beside {
  const Record& record;  ///< its tag
  const fe::Settings& settings;
  bool scalar;
};

struct Need {
  const char *tag, *attribute;  ///< tag: "" any
  bool (*met)(const Beside&);
  const char* words;  ///< what it needs
};

bool dynamic(const Beside& b) { return fe::is_dynamic(b.settings.integrator); }
bool newmark(const Beside& b) { return b.settings.integrator == fe::Integrator::newmark; }
bool along_an_arc(const Beside& b) { return b.settings.arc_length.on; }
bool iterates(const Beside& b) {
  return !fe::is_explicit(b.settings.integrator) && b.settings.linear_solver != fe::LinearSolver::direct;
}
bool clamped(const Beside& b) { return text_of(b.record, "inversion") == "clamped"; }

constexpr Need table[] = {
    {"solver", "beta", newmark, "timeIntegration=\"Newmark\""},
    {"solver", "gamma", newmark, "timeIntegration=\"Newmark\""},
    {"solver", "spectralRadius",
     [](const Beside& b) { return b.settings.integrator == fe::Integrator::generalized_alpha; },
     "timeIntegration=\"generalizedAlpha\""},
    {"solver", "dampingRayleighRatioMass", dynamic, "a dynamic timeIntegration"},
    {"solver", "dampingRayleighRatioStiffness", dynamic, "a dynamic timeIntegration"},
    {"solver", "loadSteps", [](const Beside& b) { return b.settings.integrator == fe::Integrator::static_; },
     "timeIntegration=\"static\""},
    {"solver", "stepTolerance", [](const Beside& b) { return b.settings.adaptive_step && dynamic(b); },
     "adaptiveStep=\"true\" in implicit dynamics"},
    {"solver", "arcSteps", along_an_arc, "arcLength=\"true\""},
    {"solver", "largestLoadFactor", along_an_arc, "arcLength=\"true\""},
    {"solver", "largestDisplacement", along_an_arc, "arcLength=\"true\""},
    {"solver", "preconditioner", iterates, "a linearSolver that iterates"},
    {"", "clampedBelow", clamped, "inversion=\"clamped\""},
    {"probe", "field", [](const Beside& b) { return b.scalar || text_of(b.record, "field") != "value"; },
     "a scalar problem (diffusionMaterial) for \"value\"; a solid has a displacement"}};

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

}  // namespace

void warn_of_idle(const Record& args, const fe::Settings& settings, bool scalar, Reporter& reporter) {
  for (const Need& need : table) {
    const int slot = need.tag == args.tag() || *need.tag == '\0' ? args.description->find(need.attribute) : -1;
    if (slot >= 0 && said(args, static_cast<std::size_t>(slot)) && !need.met({args, settings, scalar}))
      reporter.warn(fmt::format("{}: {} means nothing here: it needs {}. Leave it out", located(args), need.attribute,
                                need.words));
  }
  for (const Record& child : args.children) warn_of_idle(child, settings, scalar, reporter);
}

}  // namespace msml::simulation
