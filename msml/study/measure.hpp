// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers taken of a run that has ended.
#pragma once
#include "msml/run/run.hpp"
#include "msml/study/prepare.hpp"
#include "msml/study/shelf.hpp"

namespace msml {

/// What a run left in memory.
struct Finished {
  const Prepared& scene;
  const RunResult& result;
  const RunShelf& shelf;
  double apart_seconds = 0;  ///< of the same run made once more with nothing taken from others, where it is asked for
};

/// The value of a measure. `reference` is the run that errors are taken against, or null. Throws Error that says what
/// is missing.
double measure(const Measure& wanted, const StudyRun& run, const Finished& finished, const Finished* reference,
               const Registry& registry);

/// Unknowns of the simulation that the study looks at; nothing if it has none or did not get so far.
std::optional<double> unknowns(const Finished& finished);

}  // namespace msml
