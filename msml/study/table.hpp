// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a study as rows of texts, and as CSV (RFC 4180).
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace msml {

/// Rows of equal length under named columns. An empty text means: no value.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  /// Position of a column, or -1.
  int find(const std::string& column) const;
  /// The text in a column, or "" where there is no such column.
  const std::string& text(std::size_t row, const std::string& column) const;
  /// The number in a column; NaN where there is none.
  double number(std::size_t row, const std::string& column) const;
  /// True where the column `status` says done, or does not exist.
  bool done(std::size_t row) const;
  /// "tet10 0.49": the values of some columns.
  std::string words(std::size_t row, const std::vector<std::string>& some) const;
};

/// The rows that have these values.
Table filtered(const Table& table, const std::vector<std::pair<std::string, std::string>>& only);

/// Texts that are the same for each row: the values of a column, distinct, in order of first appearance.
std::vector<std::string> distinct(const Table& table, const std::vector<std::string>& columns);

std::string to_csv(const Table& table);
/// Throws Error with file and line for a row of another length.
Table parse_csv(const std::string& text, const std::string& file);
/// Throws Error if the file cannot be read.
Table read_csv(const std::filesystem::path& file);

}  // namespace msml
