// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and CSV.
#include "msml/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>

#include "msml/core/error.hpp"

namespace msml {
namespace {

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string line(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + cell(cells[i]);
  return text + "\n";
}

/// Cells of all lines; a line may go on inside quotes.
std::vector<std::vector<std::string>> cells(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> current{""};
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inside && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      current.back() += '"';
      ++i;
    } else if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      current.emplace_back();
    } else if (c == '\n' && !inside) {
      lines.push_back(std::move(current));
      current = {""};
    } else if (c != '\r' || inside) {
      current.back() += c;
    }
  }
  if (current.size() > 1 || !current.front().empty()) lines.push_back(std::move(current));
  return lines;
}

}  // namespace

int Table::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

const std::string& Table::text(std::size_t row, const std::string& column) const {
  static const std::string none;
  const int at = find(column);
  return at < 0 ? none : rows[row][static_cast<std::size_t>(at)];
}

double Table::number(std::size_t row, const std::string& column) const {
  const std::string& word = text(row, column);
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size()) return std::numeric_limits<double>::quiet_NaN();
  return value;
}

bool Table::done(std::size_t row) const { return find("status") < 0 || text(row, "status") == "done"; }

std::string Table::words(std::size_t row, const std::vector<std::string>& some) const {
  std::string all;
  for (const std::string& column : some) all += (all.empty() ? "" : ", ") + text(row, column);
  return all;
}

std::vector<std::string> distinct(const Table& table, const std::vector<std::string>& columns) {
  std::vector<std::string> found;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (const std::string words = table.words(row, columns);
        std::find(found.begin(), found.end(), words) == found.end())
      found.push_back(words);
  return found;
}

Table filtered(const Table& table, const std::vector<std::pair<std::string, std::string>>& only) {
  Table some{table.columns, {}};
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (std::all_of(only.begin(), only.end(),
                    [&](const auto& each) { return table.text(row, each.first) == each.second; }))
      some.rows.push_back(table.rows[row]);
  return some;
}

std::string to_csv(const Table& table) {
  std::string text = line(table.columns);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

Table parse_csv(const std::string& text, const std::string& file) {
  auto lines = cells(text);
  if (lines.empty()) throw Error("the file is empty", {file, 0});
  Table table{std::move(lines.front()), {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].size() != table.columns.size())
      throw Error(fmt::format("{} values, but the first line names {} columns", lines[i].size(), table.columns.size()),
                  {file, static_cast<int>(i) + 1});
    table.rows.push_back(std::move(lines[i]));
  }
  return table;
}

Table read_csv(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error("cannot read " + file.string());
  return parse_csv(text.str(), file.string());
}

}  // namespace msml
