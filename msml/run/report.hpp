// SPDX-License-Identifier: GPL-3.0-or-later
// What a run leaves behind: the summary table and the JSON report.
#pragma once
#include "msml/run/run.hpp"

namespace msml {

/// A table of time and memory per node, with the totals.
std::string summary_table(const Graph& graph, const Plan& plan, const RunResult& result);

/// The whole run as JSON: version, scene, status, time and memory per node, warnings, errors, and each node's facts.
std::string report_json(const Graph& graph, const Plan& plan, const RunResult& result, const RunOptions& options);

/// Writes ID.json beside the states of every scene output that ran.
void write_output_reports(const Graph& graph, const Plan& plan, const RunResult& result, const RunOptions& options);

}  // namespace msml
