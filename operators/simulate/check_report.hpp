// SPDX-License-Identifier: GPL-3.0-or-later
// The check after a run: what it says to a person, to a program, and what it warns of.
#pragma once
#include <string>
#include <vector>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/element_quality.hpp"

namespace msml::simulation {

/// Where the time of a run went besides what its outcome says, in seconds.
struct RunTimes {
  double steps = 0;   ///< all steps with their assembly and linear systems, without output
  double output = 0;  ///< what happens to the states: fields, files
  int states = 0;     ///< that the solver passed on
};

/// Warnings that follow from the model and the check, each a sentence that says what to change in the scene.
std::vector<std::string> check_warnings(const Simulation& simulation, const fe::Outcome& outcome,
                                        const WorstShape& worst);

/// A block of lines with aligned columns.
std::string check_text(const Simulation& simulation, const fe::Outcome& outcome, const WorstShape& worst,
                       const RunTimes& times);

/// The same as JSON: the check, its warnings, how the run ended and what it cost. Numbers that are not finite are null.
std::string check_json(const Simulation& simulation, const fe::Outcome& outcome, const WorstShape& worst,
                       const RunTimes& times, const std::vector<std::string>& warnings);

/// The settings in force as JSON, with the steps, and versions of the program and its libraries.
std::string settings_json(const Simulation& simulation);

/// The file ID.json: {"object": …, "settings": …, "check": …}.
std::string report_json(const Simulation& simulation, const std::string& settings, const std::string& check);

}  // namespace msml::simulation
