// SPDX-License-Identifier: GPL-3.0-or-later
// Replaces the laws of a body by stable ones.
#include "solver/untangle.hpp"

#include <algorithm>

#include "solver/integrators/stepper.hpp"
#include "solver/materials/law.hpp"
#include "solver/materials/neo_hookean.hpp"

namespace msml::fe {
namespace {

void stabilise(Region& region) {
  region.law = make_stable_neo_hookean(region.law->shear_modulus(), std::min(region.law->poisson_ratio(), 0.49));
  region.local_law = {};
  region.point_law = {};
}

Model stable(Model model) {
  for (Region& region : model.regions) stabilise(region);
  for (Inlay& inlay : model.inlays) stabilise(inlay.region);
  return model;
}

}  // namespace

struct Untangler::Body {
  explicit Body(const Model& original) : model(stable(original)), equations(model), newton(model, equations) {}
  Model model;
  Equations equations;
  Newton newton;
};

Untangler::Untangler(const Model& model) : body_(std::make_unique<Body>(model)) {}
Untangler::~Untangler() = default;

bool Untangler::serves(const Model& model, const Equations& equations) {
  const auto fit = [](const Region& region) {
    return region.law->survives_inversion() && !region.law->small_strain() && region.law->components() == 3;
  };
  return model.settings.untangle && model.settings.newton_iterations > 1 &&
         model.formulation == Formulation::standard && !equations.has_followers() && !equations.has_history() &&
         std::ranges::all_of(model.regions, fit) &&
         std::ranges::all_of(model.inlays, [&](const Inlay& inlay) { return fit(inlay.region); });
}

IncrementResult Untangler::run(const Increment& increment, bool rigid_free, Newton& own) {
  Newton& newton = body_->newton;
  newton.forget();
  newton.free_rigid_motions(rigid_free);
  Outcome before, after;
  newton.report(before);
  const IncrementResult result = increment.motion.dynamic() ? newton.walk(increment) : newton.run(increment);
  newton.report(after);
  own.count(after.newton_iterations - before.newton_iterations, after.linear_solves - before.linear_solves);
  return result;
}

IncrementResult Run::reach(const Increment& increment) {
  const auto go = [this](const Increment& way) { return way.motion.dynamic() ? newton.walk(way) : newton.run(way); };
  if (!tangled || !Untangler::serves(model, equations)) return go(increment);
  if (!untangler) untangler = std::make_unique<Untangler>(model);
  Increment near = increment;
  const IncrementResult led = untangler->run(increment, !free.modes.empty(), newton);
  near.start = led.u;
  near.met = led.largest_scale;
  newton.forget();
  if (near.start.allFinite()) {
    const IncrementResult result = go(near);
    newton.forget();
    if (result.stop == Stop::converged) return ++untangled, result;
  }
  return go(increment);
}

}  // namespace msml::fe
