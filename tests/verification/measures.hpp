// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the tables that a run writes.
#pragma once
#include "tests/verification/cases.hpp"

namespace msml::verification {

/// A file of numbers with a line of names.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// Throws std::runtime_error on a file that cannot be read or has no row.
Table read_table(const std::filesystem::path& file);

/// What `measure` asks of the table. Throws std::runtime_error on a column that is not there.
double measured(const Measure& measure, const Table& table);

}  // namespace msml::verification
