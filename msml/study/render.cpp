// SPDX-License-Identifier: GPL-3.0-or-later
// Pages as Markdown and as HTML.
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "msml/study/page.hpp"

namespace msml {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return out;
}

std::string markdown_table(const std::vector<std::vector<std::string>>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const std::string& each : cells[i]) text += "| " + cell(each) + " ";
    text += "|\n";
    if (i > 0) continue;
    for (std::size_t k = 0; k < cells[i].size(); ++k) text += "|---";
    text += "|\n";
  }
  return text + "\n";
}

std::string html_table(const std::vector<std::vector<std::string>>& cells) {
  std::string text = "<table>\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += "<tr>";
    for (const std::string& each : cells[i]) text += fmt::format("<{0}>{1}</{0}>", i == 0 ? "th" : "td", escaped(each));
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

/// The SVG without its XML head, so that it may stand inside HTML.
std::string picture(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const std::size_t start = text.str().find("<svg");
  return start == std::string::npos ? "<p>(no picture: gnuplot is missing)</p>\n"
                                    : "<figure>" + text.str().substr(start) + "</figure>\n";
}

constexpr const char* style =
    "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-size:14px;display:block;overflow-x:auto}"
    "td,th{border:1px solid #ccc;padding:.2em .6em;text-align:left}th{background:#f2f2f2}svg{max-width:100%}";

}  // namespace

std::string to_markdown(const Page& page) {
  std::string text;
  for (const Block& block : page) {
    if (block.kind == Block::Kind::heading)
      text += (text.empty() ? "# " : "## ") + block.text + "\n\n";
    else if (block.kind == Block::Kind::paragraph)
      text += block.text + "\n\n";
    else if (block.kind == Block::Kind::picture)
      text += fmt::format("![{0}]({0}.svg)\n\n", block.text);
    else
      text += markdown_table(block.cells);
  }
  return text;
}

std::string to_html(const Page& page, const std::filesystem::path& folder) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>"
      "<style>{}</style></head><body>\n",
      page.empty() ? "" : escaped(page.front().text), style);
  bool first = true;
  for (const Block& block : page) {
    if (block.kind == Block::Kind::heading)
      text += fmt::format("<{0}>{1}</{0}>\n", first ? "h1" : "h2", escaped(block.text));
    else if (block.kind == Block::Kind::paragraph)
      text += "<p>" + escaped(block.text) + "</p>\n";
    else
      text += block.kind == Block::Kind::picture ? picture(folder / (block.text + ".svg")) : html_table(block.cells);
    first = false;
  }
  return text + "</body></html>\n";
}

}  // namespace msml
