// SPDX-License-Identifier: GPL-3.0-or-later
// One process per run; numbers are read from its report.
#include "tests/verification/runs.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/content.hpp"
#include "tests/verification/measures.hpp"

namespace msml::verification {
namespace {

namespace fs = std::filesystem;
using testing::content;
using Json = nlohmann::json;

std::string file_name(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return text;
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

/// The scene with the method's tags exchanged.
std::string scene_text(const Program& program, const Case& each, const Method& method) {
  std::string text = content(program.scenes / each.scene);
  for (const auto& [from, to] : method.replace) {
    if (text.find(from) == std::string::npos)
      throw std::runtime_error(fmt::format("{} holds no '{}' to replace", each.scene, from));
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  }
  return text;
}

/// A file of the results or beside the scenes; empty where there is none.
fs::path found_file(const Program& program, const std::string& name) {
  for (const fs::path& folder : {program.results, program.scenes})
    if (fs::exists(folder / name)) return fs::absolute(folder / name);
  return {};
}

int execute(const Program& program, const fs::path& scene, const std::map<std::string, std::string>& set,
            const fs::path& folder) {
  std::string command =
      fmt::format("timeout 600 {} exec {} -o {} --log-json {}", quoted(program.msml.string()), quoted(scene.string()),
                  quoted(folder.string()), quoted((folder / "log.json").string()));
  for (const auto& [name, value] : set) command += " --set " + quoted(name + "=" + value);
  command += fmt::format(" >{} 2>&1", quoted((folder / "output.txt").string()));
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A run of this text with these variables, made where there is none yet.
Run run_of(const Program& program, const Case& each, const Method& method,
           const std::map<std::string, std::string>& set, const fs::path& folder, Runs& runs) {
  const std::string text = scene_text(program, each, method);
  const std::string key = each.scene + text + Json(set).dump();
  if (const auto made = runs.find(key); made != runs.end()) return made->second;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path scene = method.replace.empty() ? program.scenes / each.scene : folder / each.scene;
  if (!method.replace.empty()) std::ofstream(scene) << text;
  return runs[key] = {folder, execute(program, scene, set, folder)};
}

const Json* node_of(const Json& log, const std::string& id) {
  for (const Json& node : log.at("nodes"))
    if (node.at("id") == id) return &node;
  return nullptr;
}

double value_of(const Measure& measure, const Json& log, const fs::path& folder) {
  if (!measure.file.empty()) return measured(measure, folder);
  const Json* node = node_of(log, measure.node);
  if (node == nullptr) throw std::runtime_error("no task is called " + measure.node);
  return node->at(Json::json_pointer(measure.pointer)).get<double>();
}

int iterations_of(const Json& log) {
  int sum = 0;
  for (const Json& node : log.at("nodes"))
    if (node.contains("check")) sum += node["check"].at("newtonIterations").get<int>();
  return sum;
}

long unknowns_of(const Json& log) {
  for (const Json& node : log.at("nodes"))
    if (node.contains("check")) return node["check"].value("unknowns", 0L);
  return 0;
}

double simulation_seconds(const Json& log) {
  double sum = 0;
  for (const Json& node : log.at("nodes"))
    if (node.contains("check")) sum += node.value("seconds", 0.0);
  return sum;
}

/// The first fault of a place in the scene that the program named, or else its last line.
std::string fault(const std::string& text) {
  std::string last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool placed = line.find(".msml.xml:") != std::string::npos;
    if (placed && line.find(": warning:") == std::string::npos && line.find(" does not run: ") == std::string::npos)
      return line.size() > 320 ? line.substr(0, 320) + " …" : line;
    if (!line.empty()) last = line;
  }
  return last;
}

void judge(const Method& method, Row& row) {
  if (method.expect)
    row.error = std::abs(*row.value - *method.expect) / (*method.expect != 0 ? std::abs(*method.expect) : 1);
  if (!method.expect && !method.self) row.error = std::abs(*row.value);
  row.pass = std::isfinite(*row.value);
}

Row run_once(const Program& program, const Case& each, const Method& method,
             const std::map<std::string, std::string>& values, Runs& runs) {
  Row row{.name = each.name, .method = method.name, .source = each.source, .expect = method.expect};
  std::map<std::string, std::string> set = method.set;
  if (!method.vary.empty()) {
    for (const auto& [name, value] : values) set[name] = value;
    row.method += fmt::format("{}{} = {}", method.name.empty() ? "" : ", ", method.vary, values.at(method.vary));
  }
  for (const auto& [name, file] : method.files) set[name] = found_file(program, file).string();
  try {
    const auto [folder, code] =
        run_of(program, each, method, set, program.results / file_name(each.name + " " + row.method), runs);
    const std::string output = content(folder / "output.txt");
    if (code != method.exit_code) throw std::runtime_error(fmt::format("exit code {}: {}", code, fault(output)));
    const std::string report = content(folder / "log.json");
    if (!method.says.empty() && (output + report).find(method.says) == std::string::npos)
      throw std::runtime_error(fmt::format("does not say '{}'", method.says));
    const Json log = Json::parse(report);
    row.unknowns = unknowns_of(log);
    row.seconds = simulation_seconds(log);
    if (!method.says.empty()) row.remark = fmt::format("says '{}'", method.says);
    if (code != 0 || (method.measure.node.empty() && method.measure.file.empty())) {
      row.pass = true;
      return row;
    }
    row.value = value_of(method.measure, log, folder);
    judge(method, row);
    if (method.iterations == 0) return row;
    const int taken = iterations_of(log);
    row.remark = fmt::format("{} Newton iterations", taken);
    row.pass = row.pass && taken <= method.iterations;
  } catch (const std::exception& error) {
    row.remark = error.what();
  }
  return row;
}

/// Observed order between the last two runs: errors over the ratio of the varied numbers.
void judge_order(const Method& method, std::vector<Row>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (!rows[i].error || !rows[i - 1].error) continue;
    const double ratio = std::abs(
        std::log(std::stod(method.values[i].at(method.vary)) / std::stod(method.values[i - 1].at(method.vary))));
    rows[i].order = std::log(*rows[i - 1].error / *rows[i].error) / ratio;
  }
  Row& last = rows.back();
  last.order_asked = method.order;
  last.more = method.more;
  if (!last.pass) return;
  const double off = method.order && last.order ? *last.order - *method.order : method.order ? -1 : 0;
  const bool falls = rows.size() < 2 || method.self || !last.error || *last.error < rows.front().error.value_or(0);
  last.pass = falls && off >= -0.15 && (off <= 0.15 || !method.more.empty());
  if (!last.pass) last.remark = falls ? "another order" : "does not converge";
}

}  // namespace

std::vector<Row> run_method(const Program& program, const Case& each, const Method& method, Runs& runs) {
  std::vector<Row> rows;
  for (const auto& [name, file] : method.files)
    if (found_file(program, file).empty()) return rows;
  if (method.vary.empty()) rows.push_back(run_once(program, each, method, {}, runs));
  for (const auto& values : method.values) rows.push_back(run_once(program, each, method, values, runs));
  for (std::size_t i = 1; method.self && i < rows.size(); ++i)
    if (rows[i].value && rows[i - 1].value) rows[i].error = std::abs(*rows[i].value - *rows[i - 1].value);
  Row& last = rows.back();
  if (last.pass && last.error) {
    last.limit = method.limit;
    last.above = method.above;
    if (method.limit > 0) last.pass = *last.error <= method.limit;
    if (method.above > 0) last.pass = last.pass && *last.error >= method.above;
    if (method.limit <= 0 && method.above <= 0 && !method.order) {
      last.pass = false;
      last.remark = "nothing is asked of this number";
    }
  }
  if (!method.vary.empty()) judge_order(method, rows);
  return rows;
}

}  // namespace msml::verification
