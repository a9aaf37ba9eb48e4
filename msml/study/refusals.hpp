// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of a study that its scene refuses, told before anything runs.
#pragma once
#include "msml/study/prepare.hpp"

namespace msml {

/// The settings without a scene among the runs of a study, and a text that lists them with their reasons: one line per
/// reason, at most 20 of them.
struct Refusals {
  std::size_t refused = 0, all = 0;  ///< settings
  Fault told;                        ///< at the tag of the study; empty where nothing is refused
  /// A study none of whose settings can be carried out has nothing to run.
  bool hopeless() const { return refused == all; }
};
Refusals find_refusals(const Study& study, const std::vector<StudyRun>& runs);

}  // namespace msml
