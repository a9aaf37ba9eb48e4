// SPDX-License-Identifier: GPL-3.0-or-later
// results.json.
#include "msml/study/report.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "msml/study/columns.hpp"
#include "msml/study/keys.hpp"

namespace msml {
namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

Json row_json(const Table& table, std::size_t row) {
  Json json;
  for (const std::string& column : table.columns) {
    const double number = table.number(row, column);
    const std::string& text = table.text(row, column);
    json[column] = text.empty() ? Json() : std::isfinite(number) && column != "key" ? Json(number) : Json(text);
  }
  return json;
}

Json texts(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [name, value] : settings) json[name] = value;
  return json;
}

Json texts(const std::map<std::string, std::string>& map) { return texts(Settings(map.begin(), map.end())); }

Json formulas_json(const Formulas& formulas) {
  Json json = Json::array();
  for (const Formula& formula : formulas)
    json.push_back(formula.constant() ? Json(formula.number) : Json(formula.text));
  return json;
}

Json vary_json(const Vary& each) {
  Json json{{"variables", each.variables}};
  if (each.values.empty())
    json.update({{"from", each.from}, {"to", each.to}, {"log", each.log}, {"whole", each.whole}});
  else
    json["values"] = each.values;
  return json;
}

Json measure_json(const Measure& each) {
  constexpr const char* quantities[] = {"error", "time", "memory", "iterations", "probe", "value", "energy"};
  return {{"id", each.id},
          {"quantity", quantities[static_cast<std::size_t>(each.quantity)]},
          {"what", each.what},
          {"field", each.field},
          {"of", each.of},
          {"againstReference", each.against_truth},
          {"relative", each.relative},
          {"unit", each.unit}};
}

Json chart_json(const Chart& chart) {
  return {{"id", chart.id},
          {"title", chart.title},
          {"x", chart.x},
          {"y", chart.y},
          {"group", chart.group},
          {"only", texts(chart.only)},
          {"logX", chart.axes.log_x},
          {"logY", chart.axes.log_y},
          {"slopes", chart.slopes},
          {"color", chart.color},
          {"accurate", chart.accurate},
          {"wrong", chart.wrong},
          {"theory", formulas_json(chart.theory)},
          {"limits", chart.limits}};
}

Json definition(const Study& study) {
  constexpr const char* combinations[] = {"product", "zip", "latinHypercube"};
  Json json{{"title", study.title}, {"combine", combinations[static_cast<std::size_t>(study.combine)]}};
  if (study.combine == Combine::latin_hypercube) json["samples"] = study.samples, json["seed"] = study.seed;
  json["repetitions"] = study.repetitions();
  json["enough"] = study.enough > 0 ? Json(study.enough) : Json();
  json["limit"] = study.limit > 0 ? Json(study.limit) : Json();
  for (const Vary& each : study.vary) json["vary"].push_back(vary_json(each));
  if (study.truth)
    json["reference"] = {{"set", texts(study.truth->set)},
                         {"file", study.truth->file},
                         {"extrapolate", study.truth->extrapolate},
                         {"expected", formulas_json(study.truth->expected)},
                         {"time", study.truth->time},
                         {"limit", study.truth->limit > 0 ? Json(study.truth->limit) : Json()}};
  for (const Measure& each : study.measures) json["measures"].push_back(measure_json(each));
  json["charts"] = Json::array();
  for (const Chart& each : study.charts) json["charts"].push_back(chart_json(each));
  return json;
}

/// A hash of what a file holds, "" where it cannot be read.
std::string hash_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return in ? hash(text.str()) : "";
}

/// What was read from disk, by name.
Json inputs(const Study& study, const Graph& graph) {
  Json json = Json::object();
  for (const Node& node : graph.nodes)
    if (node.kind == NodeKind::file) json[node.file.string()] = hash_of(node.file);
  if (study.truth && !study.truth->file.empty()) json[study.truth->file] = hash_of(graph.folder / study.truth->file);
  return json;
}

Json command_line(const Session& session) {
  return {{"set", texts(session.given.set)},    {"outputFolder", session.given.output_folder.string()},
          {"strict", session.given.strict},     {"jobs", session.options.jobs},
          {"threads", session.options.threads}, {"sharing", session.options.share},
          {"keep", session.options.keep},       {"fresh", session.fresh}};
}

}  // namespace

std::string machine() {
  utsname system{};
  ::uname(&system);
  const double memory = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
  return fmt::format("{}, {} processors, {:.1f} GB, {} {}", processor(), std::thread::hardware_concurrency(),
                     memory / 1e9, system.sysname, system.release);
}

std::string study_json(const Study& study, const Table& table, const Session& session) {
  const Graph& graph = session.scene.graph;
  std::map<std::string, std::string> versions = session.versions;
  versions["msml"] = MSML_VERSION;
  Json json{{"program", "msml"},
            {"version", MSML_VERSION},
            {"versions", texts(versions)},
            {"study", study.id},
            {"scene", graph.scene},
            {"sceneHash", hash_of(graph.scene)},
            {"inputs", inputs(study, graph)},
            {"commandLine", command_line(session)},
            {"machine", machine()},
            {"seconds", session.seconds},
            {"nodesComputed", session.sharing.computed},
            {"nodesShared", session.sharing.shared},
            {"nodesComputedApart", session.sharing.apart},
            {"units", graph.units}};
  for (const auto& [name, variable] : session.scene.variables) json["variablesInForce"][name] = variable.value;
  json["variables"] = study.variables();
  json["columnUnits"] = texts(column_units(study, table, session.scene));
  json["columnLabels"] = texts(column_labels(study, table, session.scene));
  json["definition"] = definition(study);
  json["rows"] = Json::array();
  for (std::size_t row = 0; row < table.rows.size(); ++row) json["rows"].push_back(row_json(table, row));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace msml
