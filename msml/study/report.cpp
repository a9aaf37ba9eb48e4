// SPDX-License-Identifier: GPL-3.0-or-later
// results.json.
#include "msml/study/report.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

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

Json definition(const Study& study) {
  const auto texts = [](const Settings& settings) {
    Json json = Json::object();
    for (const auto& [name, value] : settings) json[name] = value;
    return json;
  };
  constexpr const char* combinations[] = {"product", "zip", "latinHypercube"};
  Json json{{"combine", combinations[static_cast<std::size_t>(study.combine)]}};
  if (study.samples > 0) json["samples"] = study.samples, json["seed"] = study.seed;
  json["vary"] = Json::array();
  for (const Vary& each : study.vary) {
    Json vary{{"variables", each.variables}};
    if (each.values.empty())
      vary.update({{"from", each.from}, {"to", each.to}, {"log", each.log}, {"whole", each.whole}});
    else
      vary["values"] = each.values;
    json["vary"].push_back(vary);
  }
  if (study.truth) {
    json["reference"] = {
        {"set", texts(study.truth->set)}, {"file", study.truth->file}, {"extrapolate", study.truth->extrapolate}};
    for (const Formula& formula : study.truth->expected)
      json["reference"]["expected"].push_back(formula.constant() ? Json(formula.number) : Json(formula.text));
  }
  json["measures"] = Json::array();
  for (const Measure& each : study.measures)
    json["measures"].push_back(
        {{"id", each.id}, {"what", each.what}, {"field", each.field}, {"of", each.of}, {"relative", each.relative}});
  return json;
}

}  // namespace

std::string machine() {
  utsname system{};
  ::uname(&system);
  const double memory = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
  return fmt::format("{}, {} processors, {:.1f} GB, {} {}", processor(), std::thread::hardware_concurrency(),
                     memory / 1e9, system.sysname, system.release);
}

std::map<std::string, std::string> column_units(const Study& study) {
  std::map<std::string, std::string> units{{"unknowns", "1"}, {"passes", "1"}};
  for (const Measure& m : study.measures) {
    units[m.id] = m.unit;
    if (m.quantity == Quantity::time) units[m.id + "_low"] = units[m.id + "_high"] = m.unit;
  }
  return units;
}

std::map<std::string, std::string> column_labels(const Study& study) {
  std::map<std::string, std::string> labels{{share_column, "share of all runs"}};
  for (const Measure& m : study.measures) {
    std::string& label = labels[m.id];
    const std::string relative = m.relative ? "relative " : "";
    if (m.quantity == Quantity::error)
      label = fmt::format("{}{} error of {}", relative, m.what, m.field);
    else if (m.quantity == Quantity::probe && m.against_truth)
      label = fmt::format("{}error at {}", relative, m.of);
    else if (m.quantity == Quantity::probe)
      label = fmt::format("{} ({}{}{} at the end)", m.id, m.what, m.what.empty() ? "" : " of ", m.of);
    else if (m.quantity == Quantity::energy)
      label = fmt::format("{}: energy made or lost, relative", m.id);
    else if (m.quantity == Quantity::memory)
      label = fmt::format("memory: {} [bytes]", m.what);
    else if (m.quantity == Quantity::iterations)
      label = m.what == "cg" ? "iterations of conjugate gradients" : fmt::format("{} iterations", m.what);
    else if (m.quantity == Quantity::time)
      label = m.what == "step"    ? "time of one step [s]"
              : m.what == "total" ? "time of all nodes [s]"
              : m.what == "own"   ? "time of nodes that are not shared [s]"
                                  : fmt::format("time of {} [s]", m.what);
    else
      label = m.unit.empty() || m.unit == "1" ? m.id : fmt::format("{} [{}]", m.id, m.unit);
  }
  return labels;
}

std::string study_json(const Study& study, const Table& table, const std::string& scene, const std::string& units,
                       const StudyOptions& options, const Sharing& sharing, double seconds) {
  Json json{{"program", "msml"},
            {"version", MSML_VERSION},
            {"study", study.id},
            {"scene", scene},
            {"machine", machine()},
            {"threads", options.threads},
            {"repetitions", study.repetitions()},
            {"enough", study.enough > 0 ? Json(study.enough) : Json()},
            {"limit", study.limit > 0 ? Json(study.limit) : Json()},
            {"seconds", seconds},
            {"nodesComputed", sharing.computed},
            {"nodesShared", sharing.shared}};
  if (!units.empty()) json["units"] = units;
  for (const auto& [column, unit] : column_units(study)) json["columnUnits"][column] = unit;
  json["variables"] = study.variables();
  json["definition"] = definition(study);
  json["rows"] = Json::array();
  for (std::size_t row = 0; row < table.rows.size(); ++row) json["rows"].push_back(row_json(table, row));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace msml
