// SPDX-License-Identifier: GPL-3.0-or-later
// study and chart.
#pragma once
#include "msml/commands/commands.hpp"
#include "msml/study/prepare.hpp"

namespace msml {

/// What stands on the command line of study.
struct StudyArguments {
  SceneArguments scene;  ///< the output folder holds one folder per study
  std::string name;      ///< the study to run; "": all of the scene
  bool html = false, fresh = false, keep = false, no_sharing = false;
  std::map<std::string, std::string> versions;  ///< of the libraries, for the record
};

/// Runs the studies of a scene and writes their tables, charts and pages. 0, or 2 for a scene with faults or a study
/// none of whose settings the scene takes, before anything runs. A run without a result does not make the command fail:
/// it is a row of the table.
int study_command(const Registry& registry, const StudyArguments& arguments);

/// Prints to stderr which settings of a study its scene refuses; false if it refuses all of them.
bool print_refusals(const Study& study, const std::vector<StudyRun>& runs);

/// What stands on the command line of chart: what is not given is as the saved chart has it.
struct ChartArguments {
  std::string table;  ///< results.csv
  std::string chart;  ///< id of a chart of the study; "": all of them, or a new one of x and y
  std::string x, y, scale, title, output, color;
  std::vector<std::string> group, only, theory;  ///< only: "name=value"; theory: formulas in X
  std::vector<double> slopes, limits;
  double accurate = 0, wrong = 0;
};

/// Draws charts of a table, with the labels and units that results.json beside it keeps. 0, or 2 after all faults have
/// been told.
int chart_command(const ChartArguments& arguments);

}  // namespace msml
