// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and JSON.
#include "msml/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "msml/core/atomic_file.hpp"
#include "msml/run/terminal.hpp"

namespace msml {
namespace {

using Json = nlohmann::ordered_json;

const char* status_name(NodeStatus status) {
  return status == NodeStatus::done ? "done" : status == NodeStatus::failed ? "failed" : "not run";
}

Json node_json(const Node& node, const NodeReport& report) {
  Json json{{"id", node.id},
            {"operator", node.tag()},
            {"line", node.where.line},
            {"status", status_name(report.status)},
            {"seconds", report.seconds},
            {"outputBytes", report.output_bytes},
            {"peakBytes", report.peak_bytes},
            {"result", report.summary}};
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  for (const auto& file : report.files) json["files"].push_back(file.string());
  for (const auto& [name, text] : report.facts) {
    const Json fact = Json::parse(text, nullptr, false);
    json[name] = fact.is_discarded() ? Json(text) : fact;
  }
  return json;
}

std::size_t peak(const RunResult& result) {
  std::size_t most = 0;
  for (const NodeReport& report : result.nodes) most = std::max(most, report.peak_bytes);
  return most;
}

std::string status(const RunResult& result) {
  if (result.errors.empty()) return "done";
  return result.errors.front().failure() == Failure::not_converged ? "not converged" : "failed";
}

}  // namespace

std::string summary_table(const Graph& graph, const Plan& plan, const RunResult& result) {
  std::size_t tag = 4, id = 2;
  for (const int i : plan.order) {
    tag = std::max(tag, graph.nodes[static_cast<std::size_t>(i)].tag().size());
    id = std::max(id, graph.nodes[static_cast<std::size_t>(i)].id.size());
  }
  std::string text =
      fmt::format("{:<{}}  {:<{}}  {:>12}  {:>12}  {:>12}  result\n", "node", tag, "id", id, "time", "holds", "peak");
  for (const int i : plan.order) {
    const Node& node = graph.nodes[static_cast<std::size_t>(i)];
    const NodeReport& report = result.nodes[static_cast<std::size_t>(i)];
    const bool ran = report.status != NodeStatus::waiting;
    text += fmt::format("{:<{}}  {:<{}}  {:>12}  {:>12}  {:>12}  {}\n", node.tag(), tag, node.id, id,
                        ran ? duration(report.seconds) : "-", ran ? megabytes(report.output_bytes) : "-",
                        ran ? megabytes(report.peak_bytes) : "-",
                        report.status == NodeStatus::done ? report.summary : status_name(report.status));
  }
  return text + fmt::format("{:<{}}  {:<{}}  {:>12}  {:>12}  {:>12}", "total", tag, "", id, duration(result.seconds),
                            "", megabytes(peak(result)));
}

std::string report_json(const Graph& graph, const Plan& plan, const RunResult& result, const RunOptions& options) {
  Json json{{"program", "msml"},
            {"version", MSML_VERSION},
            {"scene", graph.scene},
            {"status", status(result)},
            {"seconds", result.seconds},
            {"peakBytes", peak(result)},
            {"bareBytes", result.bare_bytes},
            {"jobs", options.jobs},
            {"threads", options.threads},
            {"outputFolder", options.output_folder.string()}};
  if (!graph.units.empty()) json["units"] = graph.units;
  json["nodes"] = Json::array();
  for (const int i : plan.order)
    json["nodes"].push_back(
        node_json(graph.nodes[static_cast<std::size_t>(i)], result.nodes[static_cast<std::size_t>(i)]));
  json["notRun"] = Json::array();
  for (const int i : plan.skipped) json["notRun"].push_back(graph.nodes[static_cast<std::size_t>(i)].id);
  json["errors"] = Json::array();
  for (const Error& error : result.errors) json["errors"].push_back(error.str());
  // A message may hold any bytes of a file name: replaced where they are not UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_output_reports(const Graph& graph, const Plan& plan, const RunResult& result, const RunOptions& options) {
  const std::string json = report_json(graph, plan, result, options);
  for (const int i : plan.order) {
    const Node& node = graph.nodes[static_cast<std::size_t>(i)];
    if (result.nodes[static_cast<std::size_t>(i)].status == NodeStatus::waiting) continue;
    for (const std::string& id : node.results) write_whole(options.output_folder / (id + ".json"), json);
  }
}

}  // namespace msml
