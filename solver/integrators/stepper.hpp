// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator does: walk through the steps, report states, explain failures.
#pragma once
#include "solver/newton.hpp"

namespace msml::fe {

/// The state of a run in solver numbering.
struct Motion {
  Vector u, v, a;
  Vector reaction;  ///< force of the constraint on the body; zero at free unknowns
  double time = 0;
  int step = 0, increment = 0;
};

/// Everything that an integrator works with.
struct Run {
  const Model& model;
  const Equations& equations;
  Newton& newton;
  const Observer& observer;
  Outcome& outcome;
  Motion now;
  std::vector<double> residuals;  ///< of the increment that failed
  /// Passes the present state on; false if the observer wants to stop. Sets Outcome::stop then.
  bool accept();
  /// Reactions from the forces that were last evaluated.
  void set_reactions(const Mask& fixed);
};

/// Load steps to equilibrium; see static.cpp.
void run_static(Run& run);
/// Implicit Euler or Newmark (average acceleration); see dynamic.cpp.
void run_dynamic(Run& run);

/// Sets Outcome::stop and a diagnosis in plain words from an increment that failed.
/// `share` is the share of the loads (statics) that was tried; negative in dynamics.
void explain(Run& run, const IncrementResult& result, double share);

}  // namespace msml::fe
