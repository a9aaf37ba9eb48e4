// SPDX-License-Identifier: GPL-3.0-or-later
// The verification table as text, Markdown and CSV.
#pragma once
#include "tests/verification/runs.hpp"

namespace msml::verification {

/// One line for the terminal.
std::string line(const Row& row);

/// Writes table.md and table.csv to the folder. `whole` is false where only some cases ran; the page then says so.
void write_table(const std::vector<Row>& rows, const std::filesystem::path& folder, bool whole);

}  // namespace msml::verification
