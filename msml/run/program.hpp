// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs: graphviz, gnuplot.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace msml {

/// Runs a program, found along PATH, in a folder ("" = the current one); its exit code, or -1 if it cannot be started
/// or is ended by a signal. What it says goes to /dev/null.
int run_program(const std::vector<std::string>& words, const std::filesystem::path& folder = {});

/// The first line that a program says, or "" if it cannot be started or fails.
std::string program_output(const std::vector<std::string>& words);

}  // namespace msml
