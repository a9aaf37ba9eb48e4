// SPDX-License-Identifier: GPL-3.0-or-later
// What results.json keeps of a study for charts that are drawn later.
#pragma once
#include <filesystem>
#include <optional>

#include "msml/study/chart.hpp"

namespace msml {

/// Charts as the study gave them, and the words at their axes.
struct SavedCharts {
  std::vector<Chart> charts;
  ChartStyle style;
};

/// Reads results.json; nothing where there is none, or one that holds no charts.
std::optional<SavedCharts> read_charts(const std::filesystem::path& json);

}  // namespace msml
