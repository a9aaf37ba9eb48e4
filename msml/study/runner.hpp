// SPDX-License-Identifier: GPL-3.0-or-later
// Carries out the runs of a study and fills the table of its results.
#pragma once
#include <filesystem>
#include <functional>

#include "msml/study/prepare.hpp"
#include "msml/study/table.hpp"

namespace msml {

struct StudyOptions {
  std::filesystem::path folder;  ///< of the study's results
  int jobs = 1;                  ///< runs at once, where no time is measured
  int threads = 1;               ///< threads inside a run
  bool keep = false;             ///< the files of the runs stay
  bool share = true;             ///< nodes that several runs have in common are computed once
};

/// How many nodes were computed, and how often a result was taken from another run.
struct Sharing {
  std::size_t computed = 0, shared = 0;
  std::size_t apart = 0;  ///< computed in runs that were made once more with nothing shared
};

/// The columns of a study's table: variables, status, unknowns, where a time is measured how
/// often it was (passes), measures (a time with its lowest and highest value in
/// ID_low and ID_high, an extrapolated error with the number itself in ID_value), warnings,
/// recovered (what simulations made good on the way), reason, key.
std::vector<std::string> study_columns(const Study& study);

/// Told after each run: its row, how many rows there are, and how many there will be.
using RowSink = std::function<void(const Table& table, std::size_t row)>;

/// Runs what `known` does not hold yet, which a stopped study left behind, and returns all rows in order. A run that
/// does not end well is a row with its status: refused, "not converged", "out of memory", limit, "no reference" or
/// failed, and the reason. Writes results.csv in the folder after each run.
Table run_study(const Study& study, const std::vector<StudyRun>& runs, const Registry& registry,
                const StudyOptions& options, const Table& known, const RowSink& sink, Sharing& sharing);

}  // namespace msml
