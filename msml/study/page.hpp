// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a study: the same blocks as Markdown and as one HTML file.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "msml/study/study.hpp"
#include "msml/study/table.hpp"

namespace msml {

/// A piece of a page. A table's first row is its head.
struct Block {
  enum class Kind : std::uint8_t { heading, paragraph, table, picture } kind = Kind::paragraph;
  std::string text;  ///< of a heading or paragraph; name of a picture's file without its ending
  std::vector<std::vector<std::string>> cells;
};
using Page = std::vector<Block>;

/// Why charts could not be drawn, by their ids: the page says so in their place.
using ChartProblems = std::map<std::string, std::string>;

/// What a table says about a study: slopes of the curves with their confidence, the Pareto front of error against time,
/// what 10 %, 5 %, 1 % and 0.1 % cost, ratios at the same error, the spread of samples, what went wrong, all rows.
Page make_page(const Study& study, const Table& table, const std::string& about, const ChartProblems& problems = {});

std::string to_markdown(const Page& page);
/// Pictures are the SVG files of the folder, put into the text.
std::string to_html(const Page& page, const std::filesystem::path& folder);

}  // namespace msml
