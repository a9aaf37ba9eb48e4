// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the verification scenes listed in cases.json and writes one table of errors: Markdown and CSV.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "tests/verification/cases.hpp"
#include "tests/verification/matrix.hpp"
#include "tests/verification/runs.hpp"
#include "tests/verification/table.hpp"

using namespace msml::verification;

namespace {

int usage() {
  std::cerr << "usage: verify PROGRAM FOLDER RESULTS [--smoke] [--only TEXT] [--matrix]\n"
               "  PROGRAM  the msml program\n"
               "  FOLDER   holds cases.json and the scenes\n"
               "  RESULTS  where table.md, table.csv and each run's files go\n"
               "  --smoke  the quick cases alone\n"
               "  --only   the cases with TEXT in their name\n"
               "  --matrix instead every law with every element and integration, to matrix.md\n";
  return 2;
}

bool wanted(const Case& each, bool smoke, const std::string& only) {
  return (!smoke || each.smoke) && each.name.find(only) != std::string::npos;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 3) return usage();
  const auto smoke = std::find(words.begin(), words.end(), "--smoke") != words.end();
  const auto only = std::find(words.begin(), words.end(), "--only");
  const std::string text = only != words.end() && only + 1 != words.end() ? *(only + 1) : "";
  std::vector<Row> rows;
  Runs runs;
  try {
    const Program program{words[0], words[1], words[2]};
    if (std::find(words.begin(), words.end(), "--matrix") != words.end()) return write_matrix(program) > 0 ? 1 : 0;
    for (const Case& each : read_cases(program.scenes / "cases.json")) {
      if (!wanted(each, smoke, text)) continue;
      for (const Method& method : each.methods) {
        const std::size_t first = rows.size();
        for (Row& row : run_method(program, each, method, runs)) rows.push_back(std::move(row));
        for (std::size_t i = first; i < rows.size(); ++i) std::cout << line(rows[i]) << std::endl;
      }
    }
    write_table(rows, program.results, text.empty() && !smoke);
  } catch (const std::exception& error) {
    std::cerr << "verify: " << error.what() << "\n";
    return 4;
  }
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.pass; });
  std::cout << fmt::format("{} rows, {} failed\n", rows.size(), failed);
  return rows.empty() || failed > 0 ? 1 : 0;
}
