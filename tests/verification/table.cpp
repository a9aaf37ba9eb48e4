// SPDX-License-Identifier: GPL-3.0-or-later
// Formats rows.
#include "tests/verification/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace msml::verification {
namespace {

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.7g}", *value) : ""; }
std::string short_number(const std::optional<double>& value) { return value ? fmt::format("{:.2e}", *value) : ""; }
std::string order(const Row& row) { return row.order ? fmt::format("{:.2f}", *row.order) : ""; }
std::string asked(const Row& row) {
  std::string text;
  if (row.limit > 0) text = fmt::format("<= {:.2g}", row.limit);
  if (row.above > 0) text += fmt::format("{}>= {:.2g}", text.empty() ? "" : ", ", row.above);
  if (row.order_asked)
    text += fmt::format("{}order {} {:g}{}", text.empty() ? "" : ", ", row.more.empty() ? "within .15 of" : "at least",
                        *row.order_asked, row.more.empty() ? "" : ": " + row.more);
  return text;
}
std::string verdict(const Row& row) { return row.pass ? "pass" : "FAIL"; }

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\|");
  return text;
}

std::string csv_cell(const std::string& text) {
  std::string doubled;
  for (const char c : text) doubled += c == '"' ? std::string("\"\"") : std::string(1, c);
  return "\"" + doubled + "\"";
}

void write_markdown(const std::vector<Row>& rows, std::ostream& out, bool whole) {
  double seconds = 0;
  for (const Row& row : rows) seconds += row.seconds;
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.pass; });
  out << "# Verification\n\n"
      << "Written by `./dev verify` from the scenes in this folder and `cases.json`"
      << (whole ? "" : " (a part of them)") << ". "
      << fmt::format(
             "{} rows, {} failed. Error: relative to the reference where one is given, else the measured "
             "error itself. Order: observed between this row and the one above.\n",
             rows.size(), failed);
  std::string last;
  for (const Row& row : rows) {
    if (row.name != last)
      out << fmt::format(
          "\n## {}\n\nReference: {}\n\n| method | unknowns | value | reference | error | asked | order "
          "| time (s) | |\n|---|---:|---:|---:|---:|---|---:|---:|---|\n",
          row.name, row.source);
    last = row.name;
    out << fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.2f} | {}{} |\n", cell(row.method), row.unknowns,
                       number(row.value), number(row.expect), short_number(row.error), cell(asked(row)), order(row),
                       row.seconds, verdict(row), row.remark.empty() ? "" : ": " + cell(row.remark));
  }
}

void write_csv(const std::vector<Row>& rows, std::ostream& out) {
  out << "case,method,unknowns,value,reference,error,limit,above,order,seconds,pass,remark,source\n";
  for (const Row& row : rows)
    out << fmt::format("{},{},{},{},{},{},{},{},{},{:.3f},{},{},{}\n", csv_cell(row.name), csv_cell(row.method),
                       row.unknowns, number(row.value), number(row.expect), short_number(row.error), row.limit,
                       row.above, order(row), row.seconds, row.pass ? 1 : 0, csv_cell(row.remark),
                       csv_cell(row.source));
}

}  // namespace

std::string line(const Row& row) {
  return fmt::format("{:4} {:44.44} {:36.36} {:>8} {:>13} {:>9} {:>5} {:7.2f} s {}", verdict(row), row.name, row.method,
                     row.unknowns, number(row.value), short_number(row.error), order(row), row.seconds, row.remark);
}

void write_table(const std::vector<Row>& rows, const std::filesystem::path& folder, bool whole) {
  std::filesystem::create_directories(folder);
  std::ofstream markdown(folder / "table.md"), csv(folder / "table.csv");
  write_markdown(rows, markdown, whole);
  write_csv(rows, csv);
}

}  // namespace msml::verification
