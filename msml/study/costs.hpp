// SPDX-License-Identifier: GPL-3.0-or-later
// What accuracy costs: the part of a page that weighs errors against time and unknowns.
#pragma once
#include "msml/study/page.hpp"

namespace msml {

/// For each relative error that a chart draws, or else that is measured, and the rows of that chart: the Pareto front
/// against the first time of the study, the cheapest run for 10 %, 5 %, 1 % and 0.1 %, and what each method (a group of
/// the chart) needs for the same error, as a ratio to the best.
Page cost_blocks(const Study& study, const Table& table);

}  // namespace msml
