// SPDX-License-Identifier: GPL-3.0-or-later
// Units and labels of columns.
#include "msml/study/columns.hpp"

#include <fmt/format.h>

#include <cmath>

#include "msml/study/units.hpp"

namespace msml {
namespace {

/// True for a column in which some row holds a word.
bool holds_words(const Table& table, const std::string& column) {
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (!table.text(row, column).empty() && !std::isfinite(table.number(row, column))) return true;
  return false;
}

std::string time_words(const std::string& what) {
  if (what == "step") return "time of one step";
  if (what == "total") return "time of all nodes";
  if (what == "own") return "time of nodes that are not shared";
  if (what == "run") return "time of a run, sharing on";
  if (what == "apart") return "time of a run, sharing off";
  return "time of " + what;
}

/// What a measure is, without its unit.
std::string words_of(const Measure& m) {
  const std::string relative = m.relative ? "relative " : "";
  switch (m.quantity) {
    case Quantity::error:
      return fmt::format("{}{} error of {}", relative, m.what, m.field);
    case Quantity::probe:
      if (m.against_truth) return fmt::format("{}error at {}", relative, m.of);
      return fmt::format("{} ({}{}{} at the end)", m.id, m.what, m.what.empty() ? "" : " of ", m.of);
    case Quantity::energy:
      return fmt::format("{}: energy made or lost, relative", m.id);
    case Quantity::memory:
      return "memory: " + m.what;
    case Quantity::iterations:
      return m.what == "cg" ? "iterations of conjugate gradients" : m.what + " iterations";
    case Quantity::time:
      return time_words(m.what);
    default:
      return m.against_truth ? fmt::format("{}error of {}", relative, m.of) : m.id;
  }
}

}  // namespace

std::map<std::string, std::string> column_units(const Study& study, const Table& table, const Compilation& scene) {
  std::map<std::string, std::string> units{{"unknowns", "1"}, {"passes", "1"}};
  for (const std::string& column : table.columns)
    if (!units.contains(column)) units[column] = "text";
  for (const std::string& name : study.variables()) {
    const auto known = scene.variables.find(name);
    units[name] = holds_words(table, name)         ? "text"
                  : known == scene.variables.end() ? ""
                                                   : in_labels(known->second.unit, scene.graph.units);
  }
  for (const Measure& m : study.measures) {
    units[m.id] = in_labels(m.unit, scene.graph.units);
    if (m.quantity == Quantity::time) units[m.id + "_low"] = units[m.id + "_high"] = units[m.id];
    if (m.extrapolated) units[m.id + "_value"] = in_labels(m.value_unit, scene.graph.units);
  }
  return units;
}

std::map<std::string, std::string> column_labels(const Study& study, const Table& table, const Compilation& scene) {
  std::map<std::string, std::string> labels{{share_column, "share of all runs"}};
  const auto units = column_units(study, table, scene);
  const auto add = [&](const std::string& column, const std::string& words) {
    const std::string& unit = units.at(column);
    labels[column] = unit.empty() || unit == "1" || unit == "text" ? words : fmt::format("{} [{}]", words, unit);
  };
  for (const std::string& name : study.variables()) add(name, name);
  for (const Measure& m : study.measures) add(m.id, words_of(m));
  return labels;
}

}  // namespace msml
