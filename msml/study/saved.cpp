// SPDX-License-Identifier: GPL-3.0-or-later
// results.json -> charts.
#include "msml/study/saved.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace msml {
namespace {

using Json = nlohmann::json;

Formulas formulas(const Json& json) {
  Formulas found;
  for (const Json& each : json)
    found.push_back(each.is_number() ? Formula(each.get<double>()) : Formula(each.get<std::string>()));
  return found;
}

Chart chart_of(const Json& json) {
  Chart chart{.id = json.at("id"), .title = json.at("title"), .x = json.at("x"), .y = json.at("y"), .where = {}};
  chart.group = json.at("group").get<std::vector<std::string>>();
  for (const auto& [name, value] : json.at("only").items()) chart.only.emplace_back(name, value);
  chart.axes = {json.at("logX"), json.at("logY")};
  chart.slopes = json.at("slopes").get<std::vector<double>>();
  chart.color = json.at("color");
  chart.accurate = json.at("accurate");
  chart.wrong = json.at("wrong");
  chart.theory = formulas(json.at("theory"));
  chart.limits = json.at("limits").get<std::vector<double>>();
  return chart;
}

}  // namespace

std::optional<SavedCharts> read_charts(const std::filesystem::path& json) {
  std::ifstream in(json);
  if (!in) return std::nullopt;
  const Json all = Json::parse(in, nullptr, false);
  try {
    SavedCharts saved;
    for (const Json& each : all.at("definition").at("charts")) saved.charts.push_back(chart_of(each));
    saved.style.labels = all.at("columnLabels").get<std::map<std::string, std::string>>();
    saved.style.joined = all.at("definition").at("combine") != "latinHypercube";
    return saved;
  } catch (const Json::exception&) {
    return std::nullopt;  // of another version, or no study's
  }
}

}  // namespace msml
