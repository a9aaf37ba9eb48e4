// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a study as JSON, with the machine they were taken on.
#pragma once
#include <map>
#include <string>

#include "msml/study/runner.hpp"

namespace msml {

/// "AMD EPYC 7763, 2 processors, 16.4 GB, Linux 6.1": what timings depend on.
std::string machine();

/// Units by column: "s" and "bytes" of measures.
std::map<std::string, std::string> column_units(const Study& study);

/// What stands at the axes of charts: "relative RMS error of displacement", "time of one step [s]".
std::map<std::string, std::string> column_labels(const Study& study);

/// Study, scene, units, settings, versions, machine, and one object per row with numbers as numbers.
std::string study_json(const Study& study, const Table& table, const std::string& scene, const std::string& units,
                       const StudyOptions& options, const Sharing& sharing, double seconds);

}  // namespace msml
