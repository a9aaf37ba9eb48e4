// SPDX-License-Identifier: GPL-3.0-or-later
// Errors, times, memory, iterations, probes and energies of a run.
#include "msml/study/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "msml/core/silent_reporter.hpp"
#include "msml/study/table.hpp"

namespace msml {
namespace {

using Json = nlohmann::json;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Calls an operator of the registry with some attributes given, and returns its first output.
Value call(const Registry& registry, const std::string& tag, const std::map<std::string, Value>& given) {
  const Operator* op = registry.find_operator(tag);
  if (!op) throw Error("this build has no " + tag);
  Record record{.description = op, .where = {}, .id = {}, .values = {}, .given = {}, .children = {}};
  for (const Slot& slot : op->slots()) {
    const auto found = slot.role == Role::output ? given.end() : given.find(slot.name);
    record.values.push_back(found == given.end() ? slot.fallback : found->second);
    record.given.push_back(found != given.end());
  }
  SilentReporter quiet;
  Context context(record, quiet, ".", 1);
  (*op)(context);
  return context.outputs[at(op->first_output())];
}

Edge output(const Finished& finished, const std::string& name) {
  const auto edge = find_output(finished.scene.graph, name);
  if (!edge || edge->slot < 0) throw Error(fmt::format("there is no output '{}'", name));
  return *edge;
}

const Value& value_of(const Finished& finished, const std::string& name) {
  const Edge edge = output(finished, name);
  const auto* outputs = finished.shelf.outputs(edge.node);
  if (!outputs || outputs->size() <= at(edge.slot)) throw Error(fmt::format("'{}' gave nothing", name));
  return (*outputs)[at(edge.slot)];
}

Value mesh_of(const Finished& finished, const std::string& name) {
  return convert(value_of(finished, name), Type::mesh);
}

double field_error(const Measure& wanted, const StudyRun& run, const Finished& finished, const Finished* reference,
                   const Registry& registry) {
  std::map<std::string, Value> given{{"mesh", mesh_of(finished, wanted.of)},
                                     {"field", wanted.field},
                                     {"norm", wanted.what},
                                     {"relative", wanted.relative}};
  const Truth& truth = *run.study.truth;
  if (!truth.expected.empty()) {
    given["expected"] = truth.expected;
    given["time"] = truth.time;
  } else {
    given["referenceMesh"] = reference ? mesh_of(*reference, wanted.of)
                                       : registry.read(finished.scene.graph.folder / truth.file, Type::mesh);
  }
  return std::get<double>(call(registry, "ComputeFieldError", given));
}

/// A fact that the simulation of the output noted, as JSON; null where there is none.
Json fact(const Finished& finished, const std::string& of, const std::string& name) {
  const auto& facts = finished.result.nodes[at(output(finished, of).node)].facts;
  const auto found = facts.find(name);
  return found == facts.end() ? Json() : Json::parse(found->second, nullptr, false);
}

double number(const Json& json, const Json::json_pointer& pointer) {
  const Json found = json.is_structured() ? json.value(pointer, Json()) : Json();
  if (!found.is_number()) throw Error(fmt::format("the run notes no {}", pointer.to_string()));
  return found.get<double>();
}

double increments(const Json& settings) {
  if (settings.value("timeIntegration", "") == "static") return settings.value("loadSteps", 1.0);
  double count = 0;
  for (const Json& step : settings.value("steps", Json::array())) count += step.value("iterations", 0.0);
  return std::max(1.0, count);
}

double seconds(const Measure& wanted, const Finished& finished) {
  const auto& nodes = finished.result.nodes;
  if (wanted.what == "run") return finished.result.seconds;
  if (wanted.what == "apart") return finished.apart_seconds;
  if (wanted.what == "total" || wanted.what == "own") {
    double sum = 0;
    for (const int node : finished.scene.plan.order)
      if (wanted.what == "total" || !nodes[at(node)].taken) sum += nodes[at(node)].seconds;
    return sum;
  }
  const auto spent = [&](const char* part) {
    return number(fact(finished, wanted.of, "check"), Json::json_pointer(std::string("/seconds/") + part));
  };
  if (wanted.what == "setup" || wanted.what == "assembly" || wanted.what == "linear") return spent(wanted.what.c_str());
  if (wanted.what == "simulation")
    return std::max(0.0, nodes[at(output(finished, wanted.of).node)].seconds - spent("output"));
  if (wanted.what == "step") return spent("steps") / increments(fact(finished, wanted.of, "settings"));
  return nodes[at(output(finished, wanted.what).node)].seconds;
}

double memory(const Measure& wanted, const Finished& finished) {
  if (wanted.what == "peak") {
    std::size_t most = 0;
    for (const int node : finished.scene.plan.order) most = std::max(most, finished.result.nodes[at(node)].peak_bytes);
    return static_cast<double>(most);
  }
  return number(fact(finished, wanted.of, "check"), Json::json_pointer("/bytes/" + wanted.what));
}

double iterations(const Measure& wanted, const Finished& finished) {
  const std::string name = wanted.what == "newton"   ? "/newtonIterations"
                           : wanted.what == "linear" ? "/linearSolves"
                                                     : "/cgIterations";
  return number(fact(finished, wanted.of, "check"), Json::json_pointer(name));
}

Table csv_of(const Finished& finished, const std::string& name) {
  const auto* file = std::get_if<File>(&value_of(finished, name));
  if (!file) throw Error(fmt::format("'{}' is no probe and no energies", name));
  return read_csv(file->path);
}

/// The last row of a probe: one column, or all but the time.
std::vector<double> last_row(const Finished& finished, const Measure& wanted) {
  const Table table = csv_of(finished, wanted.of);
  if (table.rows.empty()) throw Error(fmt::format("the probe '{}' has no row", wanted.of));
  std::vector<double> row;
  for (const std::string& column : table.columns)
    if (wanted.what.empty() ? column != "time" : column == wanted.what || column.ends_with("_" + wanted.what))
      row.push_back(table.number(table.rows.size() - 1, column));
  if (row.empty()) throw Error(fmt::format("the probe '{}' has no column {}", wanted.of, wanted.what));
  return row;
}

double length(const std::vector<double>& row) {
  double sum = 0;
  for (const double x : row) sum += x * x;
  return std::sqrt(sum);
}

double probe(const Measure& wanted, const Finished& finished, const Finished* reference) {
  const std::vector<double> found = last_row(finished, wanted);
  if (!wanted.against_truth || wanted.extrapolated) return found.size() == 1 ? found.front() : length(found);
  if (!reference) throw Error("the error of a probe needs <reference set=…> or extrapolate");
  const std::vector<double> exact = last_row(*reference, wanted);
  if (exact.size() != found.size()) throw Error("the probe has other columns in the reference");
  std::vector<double> difference(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) difference[i] = found[i] - exact[i];
  return length(difference) / (wanted.relative ? length(exact) : 1);
}

/// Largest change of what is conserved, relative to the largest energy that moved.
double energy_drift(const Measure& wanted, const Finished& finished) {
  const Table table = csv_of(finished, wanted.of);
  double largest = 0, drift = 0, first = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double elastic = table.number(row, "elastic"), kinetic = table.number(row, "kinetic");
    const double work = table.number(row, "external_work");
    const double total = elastic + kinetic + table.number(row, "dissipated") - work;
    if (row == 0) first = total;
    largest = std::max({largest, std::abs(elastic), std::abs(kinetic), std::abs(work)});
    drift = std::max(drift, std::abs(total - first));
  }
  return largest > 0 ? drift / largest : 0;
}

double plain_value(const Measure& wanted, const Finished& finished) {
  const Value& value = value_of(finished, wanted.of);
  if (!converts(type(value), Type::number)) throw Error(fmt::format("'{}' is no number", wanted.of));
  return std::get<double>(convert(value, Type::number));
}

/// A number of a task, or how far it is from that of the reference.
double task_value(const Measure& wanted, const Finished& finished, const Finished* reference) {
  const double found = plain_value(wanted, finished);
  if (!wanted.against_truth || wanted.extrapolated) return found;
  if (!reference) throw Error("the error of a value needs <reference set=…> or extrapolate");
  const double exact = plain_value(wanted, *reference);
  return std::abs(found - exact) / (wanted.relative ? std::abs(exact) : 1);
}

double raw(const Measure& wanted, const StudyRun& run, const Finished& finished, const Finished* reference,
           const Registry& registry) {
  switch (wanted.quantity) {
    case Quantity::error:
      return field_error(wanted, run, finished, reference, registry);
    case Quantity::time:
      return seconds(wanted, finished);
    case Quantity::memory:
      return memory(wanted, finished);
    case Quantity::iterations:
      return iterations(wanted, finished);
    case Quantity::probe:
      return probe(wanted, finished, reference);
    case Quantity::energy:
      return energy_drift(wanted, finished);
    default:
      return task_value(wanted, finished, reference);
  }
}

}  // namespace

double measure(const Measure& wanted, const StudyRun& run, const Finished& finished, const Finished* reference,
               const Registry& registry) {
  try {
    const double found = raw(wanted, run, finished, reference, registry);
    if (!std::isfinite(found)) throw Error("it is not a finite number");
    return found;
  } catch (const Error& error) {
    throw Error(fmt::format("measure '{}': {}", wanted.id, error.what()), wanted.where, error.failure());
  }
}

std::optional<double> unknowns(const Finished& finished) {
  const auto edge = find_output(finished.scene.graph, "");
  if (!edge) return std::nullopt;
  const auto& facts = finished.result.nodes[at(edge->node)].facts;
  auto found = facts.find("check");
  if (found == facts.end()) found = facts.find("size");
  if (found == facts.end()) return std::nullopt;
  const Json count = Json::parse(found->second, nullptr, false).value("unknowns", Json());
  return count.is_number() ? std::optional(count.get<double>()) : std::nullopt;
}

}  // namespace msml
