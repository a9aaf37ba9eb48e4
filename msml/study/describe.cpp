// SPDX-License-Identifier: GPL-3.0-or-later
// The tags of <studies>, each described once with what it builds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/study/expand.hpp"
#include "msml/study/study.hpp"

namespace msml {
namespace {

/// A description that builds part of a study and says what is wrong with it.
template <class Result>
using Part = Factory<std::function<Result(const FaultSink&)>>;

std::string text_of(const Record& record, Key<std::string> key) { return record.has(key) ? record[key] : ""; }

Part<Vary> vary_tag() {
  Part<Vary> tag("vary", "vary", "A variable of the scene, or several together, and the values they take.");
  const auto variable = tag.parameter<Words>("variable", {.doc = "its name; several names vary together"});
  const auto values = tag.parameter<std::string>(
      "values", {.optional = true,
                 .doc = "a list; with ';' between the values where one holds blanks or stands for several "
                        "variables, or with braces around what belongs together: {1 2 7}"});
  const auto from = tag.parameter("from", {.optional = true, .doc = "first value of a range"});
  const auto to = tag.parameter("to", {.optional = true, .doc = "last value of a range"});
  const auto count =
      tag.parameter<Integer>("count", {.range = closed(1, 100000), .optional = true, .doc = "values in the range"});
  const auto scale = tag.parameter<std::string>(
      "scale", {.fallback = "linear", .choices = {"linear", "log"}, .doc = "equal differences or equal ratios"});
  const auto whole = tag.parameter<bool>("whole", {.fallback = false, .doc = "round the values of a range"});
  tag.build([=](const Record& record) {
    return [=](const FaultSink& fault) {
      Vary vary{.variables = record[variable], .values = {}, .where = record.where};
      vary.log = record[scale] == "log";
      vary.whole = record[whole];
      vary.ranged = !record.has(values);
      if (!vary.ranged) {
        vary.values = parse_values(record[values], vary, fault);
        if (record.has(from) || record.has(to) || record.has(count))
          fault(record.where, "vary has values and a range (from, to, count): give one of them");
        return vary;
      }
      if (!record.has(from) || !record.has(to))
        return fault(record.where, "vary needs values, or from and to with count"), vary;
      vary.from = record[from], vary.to = record[to];
      if (vary.variables.size() != 1) fault(record.where, "a range varies one variable; several need values");
      if (vary.log && !(vary.from > 0 && vary.to > 0))
        fault(record.where, fmt::format("scale = log needs from and to > 0, not {} and {}", vary.from, vary.to));
      else if (record.has(count))
        vary.values = range_values(vary, static_cast<int>(record[count]));
      return vary;
    };
  });
  return tag;
}

Part<Truth> reference_tag() {
  Part<Truth> tag("reference", "reference",
                  "What errors are taken against: one of set, file, expression, extrapolate.");
  const auto set = tag.parameter<std::string>(
      "set", {.optional = true,
              .doc = "the same scene with other values: 'n=16 quadratic=true'; ';' between them "
                     "where a value holds blanks"});
  const auto file = tag.parameter<std::string>("file", {.optional = true, .doc = "a mesh with the field"});
  const auto expression = tag.parameter<Formulas>(
      "expression", {.optional = true, .doc = "the exact field, a formula in X, Y, Z, t for each component"});
  const auto limit = tag.parameter("limit", {.unit = "seconds",
                                             .range = positive(),
                                             .optional = true,
                                             .doc = "of the run of set, where it is not that of the study's runs"});
  const auto time = tag.parameter("time", {.unit = "time", .fallback = 0.0, .doc = "value of t in expression"});
  const auto extrapolate = tag.parameter<std::string>(
      "extrapolate", {.optional = true,
                      .doc = "a variable that varies from coarse to fine: probes and values are held against the limit "
                             "of their last three, one limit for each setting of the other variables"});
  tag.build([=](const Record& record) {
    return [=](const FaultSink& fault) {
      Truth truth{
          .set = {}, .file = text_of(record, file), .expected = {}, .time = record[time], .where = record.where};
      if (record.has(set)) truth.set = parse_settings(record[set], record.where, fault);
      if (record.has(expression)) truth.expected = record[expression];
      truth.extrapolate = text_of(record, extrapolate);
      truth.limit = record.has(limit) ? record[limit] : 0;
      if (record.has(limit) && !record.has(set))
        fault(record.where, "limit is that of the run of set: give set, or no limit");
      if (record.has(set) + record.has(file) + record.has(expression) + record.has(extrapolate) != 1)
        fault(record.where, "reference needs one of set, file, expression, extrapolate");
      return truth;
    };
  });
  return tag;
}

struct MeasureKeys {
  Key<std::string> id, error, field, of, time, memory, iterations, probe, value, component, energy;
  Key<bool> relative;
};

MeasureKeys describe_measure(Description& tag) {
  MeasureKeys k;
  k.id = tag.parameter<std::string>("id", {.optional = true, .doc = "name of the column"});
  k.error = tag.parameter<std::string>(
      "error", {.optional = true,
                .choices = {"RMS", "L2", "H1", "maximum"},
                .doc = "of a field against the reference; RMS and maximum at the reference's nodes; with probe or "
                       "value: the error of that number"});
  k.field = tag.parameter<std::string>("field", {.fallback = "displacement", .doc = "of the error"});
  k.relative =
      tag.parameter<bool>("relative", {.fallback = true, .doc = "divide the error by the norm of the reference"});
  k.of = tag.parameter<std::string>(
      "of", {.optional = true, .doc = "scene output (or task) that is measured; default: the first series of states"});
  k.time = tag.parameter<std::string>(
      "time", {.optional = true,
               .doc = "seconds: run (by the clock, with what earlier runs computed taken "
                      "from them), apart (by the clock, the same once more with nothing "
                      "taken from others), total (sum of all nodes), own (sum of those that "
                      "no earlier run computed), simulation, step (of one time step), setup, assembly, "
                      "linear, or the id of a task"});
  k.memory =
      tag.parameter<std::string>("memory", {.optional = true, .choices = {"peak", "matrix", "factor"}, .doc = "bytes"});
  k.iterations = tag.parameter<std::string>(
      "iterations", {.optional = true, .choices = {"newton", "linear", "cg"}, .doc = "how many"});
  k.probe = tag.parameter<std::string>("probe", {.optional = true, .doc = "id of a probe: its last row"});
  k.component = tag.parameter<std::string>(
      "component", {.optional = true, .doc = "column of the probe; default: the length of the vector"});
  k.value = tag.parameter<std::string>("value",
                                       {.optional = true, .doc = "a task whose output is a number: id or id.output"});
  k.energy = tag.parameter<std::string>(
      "energy", {.optional = true,
                 .doc = "id of energies: largest change of (elastic + kinetic + dissipated - work) "
                        "relative to the largest energy"});
  return k;
}

/// Fills what the chosen quantity needs; the number of quantities that are chosen.
int choose_quantity(const Record& record, const MeasureKeys& k, Measure& m) {
  int chosen = 0;
  const auto take = [&](Key<std::string> key, Quantity quantity, const char* unit, bool names_node) {
    if (!record.has(key)) return;
    ++chosen;
    m.quantity = quantity;
    m.unit = unit;
    (names_node ? m.of : m.what) = record[key];
  };
  take(k.time, Quantity::time, "s", false);
  take(k.memory, Quantity::memory, "bytes", false);
  take(k.iterations, Quantity::iterations, "1", false);
  take(k.probe, Quantity::probe, "", true);
  take(k.value, Quantity::value, "", true);
  take(k.energy, Quantity::energy, "1", true);
  if (record.has(k.error)) {
    m.what = record[k.error];
    m.against_truth = true;
    if (!record.has(k.probe) && !record.has(k.value)) ++chosen, m.quantity = Quantity::error;
    m.unit = record[k.relative] ? "1" : "";
  }
  if (m.quantity == Quantity::probe) m.what = text_of(record, k.component);
  return chosen;
}

std::string default_name(const Measure& m) {
  switch (m.quantity) {
    case Quantity::error:
      return fmt::format("error_{}", m.what);
    case Quantity::time:
      return fmt::format("time_{}", m.what);
    case Quantity::memory:
      return fmt::format("memory_{}", m.what);
    case Quantity::iterations:
      return fmt::format("iterations_{}", m.what);
    case Quantity::probe:
      return fmt::format("{}{}{}{}", m.against_truth ? "error_" : "", m.of, m.what.empty() ? "" : "_", m.what);
    default:
      return (m.against_truth ? "error_" : "") + m.of;
  }
}

Part<Measure> measure_tag() {
  Part<Measure> tag("measure", "measure", "A number that is taken of each run, and becomes a column of the table.");
  const MeasureKeys k = describe_measure(tag);
  tag.note("The columns status, unknowns, warnings, recovered and reason are always there.");
  tag.build([=](const Record& record) {
    return [=](const FaultSink& fault) {
      Measure m{.id = "",
                .what = "",
                .field = record[k.field],
                .of = text_of(record, k.of),
                .unit = "",
                .value_unit = "",
                .where = record.where};
      m.relative = record[k.relative];
      if (choose_quantity(record, k, m) != 1)
        fault(record.where, "measure needs one of error, time, memory, iterations, probe, value, energy");
      m.id = record.has(k.id) ? record[k.id] : default_name(m);
      return m;
    };
  });
  return tag;
}

Part<Chart> chart_tag() {
  Part<Chart> tag("chart", "chart", "A picture of one column over another.");
  const auto id = tag.parameter<std::string>("id", {.optional = true, .doc = "name of the files; default: y_over_x"});
  const auto x = tag.parameter<std::string>("x", {.doc = "a variable, unknowns or a measure"});
  const auto y = tag.parameter<std::string>(
      "y", {.doc = "a measure; of a map a variable; or share: of the values of x, those that are not larger"});
  const auto group =
      tag.parameter<Words>("group", {.fallback = Words{}, .doc = "variables whose values make the curves"});
  const auto scale = tag.parameter<std::string>(
      "scale", {.fallback = "loglog", .choices = {"loglog", "linear", "logx", "logy"}, .doc = "of the axes"});
  const auto only = tag.parameter<std::string>(
      "only",
      {.optional = true, .doc = "rows that are drawn: 'load=twist'; ';' between them where a value holds blanks"});
  const auto slopes = tag.parameter<std::vector<double>>(
      "slopes", {.fallback = std::vector<double>{}, .doc = "slopes to be drawn as triangles: -0.667 …"});
  const auto color = tag.parameter<std::string>(
      "color", {.optional = true,
                .doc = "makes a map of two variables, x and y: each run a cell, coloured by this error "
                       "and by whether it ended well"});
  const auto accurate = tag.parameter(
      "accurate", {.range = positive(), .fallback = 0.05, .doc = "of a map: errors up to this are accurate"});
  const auto wrong =
      tag.parameter("wrong", {.range = positive(),
                              .fallback = 1.0,
                              .doc = "of a map: errors above this are wrong results that nothing told of"});
  const auto theory = tag.parameter<Formulas>(
      "theory", {.fallback = Formulas{}, .doc = "lines to be drawn: y as formulas in X, the value of x"});
  const auto limits = tag.parameter<std::vector<double>>(
      "limits", {.fallback = std::vector<double>{}, .doc = "values of x to be marked, such as a largest stable step"});
  const auto title = tag.parameter<std::string>("title", {.optional = true, .doc = "above the chart"});
  tag.build([=](const Record& record) {
    return [=](const FaultSink& fault) {
      Chart chart{.id = "",
                  .title = text_of(record, title),
                  .x = record[x],
                  .y = record[y],
                  .group = record[group],
                  .only = {},
                  .axes = {},
                  .slopes = record[slopes],
                  .color = text_of(record, color),
                  .accurate = record[accurate],
                  .wrong = record[wrong],
                  .theory = record[theory],
                  .limits = record[limits],
                  .where = record.where};
      if (record.has(only)) chart.only = parse_settings(record[only], record.where, fault);
      chart.id = record.has(id) ? record[id] : chart.y + "_over_" + chart.x;
      const std::string& s = record[scale];
      chart.axes = {s == "loglog" || s == "logx", s == "loglog" || s == "logy"};
      return chart;
    };
  });
  return tag;
}

struct StudyKeys {
  Key<std::string> id, title, combine;
  Key<Integer> samples, seed, repeat;
  Key<double> enough, limit;
};

Description study_tag(StudyKeys& k) {
  Description tag("study", "study", "Runs the scene many times, measures each run, charts what came out.");
  k.id = tag.parameter<std::string>("id", {.doc = "its name, and that of its folder of results"});
  k.title = tag.parameter<std::string>("title", {.optional = true, .doc = "head of the page"});
  k.combine = tag.parameter<std::string>(
      "combine", {.fallback = "product",
                  .choices = {"product", "zip", "latinHypercube"},
                  .doc = "every value with every other; first with first, second with second; or samples of ranges"});
  k.samples =
      tag.parameter<Integer>("samples", {.range = closed(1, 100000), .fallback = 100, .doc = "of latinHypercube"});
  k.seed = tag.parameter<Integer>("seed", {.range = closed(0, 1 << 30), .fallback = 1, .doc = "of latinHypercube"});
  k.repeat = tag.parameter<Integer>("repeat", {.range = closed(1, 1000),
                                               .optional = true,
                                               .doc = "how often each timing is taken; default 5, the median counts"});
  k.enough = tag.parameter("enough", {.unit = "seconds",
                                      .range = positive(),
                                      .optional = true,
                                      .doc = "a run whose passes have taken this long is not repeated again; the "
                                             "column passes says how often it was timed"});
  k.limit = tag.parameter(
      "limit",
      {.unit = "seconds",
       .range = positive(),
       .optional = true,
       .doc =
           "a run that takes longer is ended and is a data point with status 'limit'; looked at between tasks, and in "
           "them between passes of meshing, iterations, grids and factorisations, of "
           "which one that has begun is finished; the reference has the same limit"});
  tag.allow({"vary", 1});
  tag.allow({"reference", 0, 1});
  tag.allow({"measure"});
  tag.allow({"chart"});
  return tag;
}

/// The parts of a study of one kind that make sense; the kind is `unread` where one does not.
template <class Result>
std::vector<Result> build(const Record& study, const std::string& kind, const FaultSink& fault,
                          std::set<std::string>& unread) {
  std::vector<Result> parts;
  for (const Record* each : study.of_category(kind)) {
    bool good = true;
    const FaultSink told = [&](const Location& where, const std::string& what) { good = false, fault(where, what); };
    Result part = dynamic_cast<const Part<Result>&>(*each->description).make(*each)(told);
    if (good)
      parts.push_back(std::move(part));
    else
      unread.insert(kind);
  }
  return parts;
}

void add(Registry& registry, Description description) {
  registry.add(std::make_shared<const Description>(std::move(description)));
}

}  // namespace

void add_study_tags(Registry& registry) {
  Description studies("studies", "studies", "Parameter studies of the scene, run by `msml study`.");
  studies.allow({"study"});
  add(registry, std::move(studies));
  StudyKeys keys;
  add(registry, study_tag(keys));
  registry.add(std::make_shared<const Part<Vary>>(vary_tag()));
  registry.add(std::make_shared<const Part<Truth>>(reference_tag()));
  registry.add(std::make_shared<const Part<Measure>>(measure_tag()));
  registry.add(std::make_shared<const Part<Chart>>(chart_tag()));
}

Study make_study(const Record& record, const FaultSink& fault, std::set<std::string> unread) {
  StudyKeys k;
  study_tag(k);  // the keys are always the same
  Study study{.id = record[k.id],
              .title = text_of(record, k.title),
              .vary = {},
              .truth = {},
              .measures = {},
              .charts = {},
              .unread = {},
              .where = record.where};
  const std::string& combine = record[k.combine];
  study.combine = combine == "product" ? Combine::product : combine == "zip" ? Combine::zip : Combine::latin_hypercube;
  study.samples = static_cast<int>(record[k.samples]);
  study.seed = static_cast<int>(record[k.seed]);
  study.repeat = record.has(k.repeat) ? static_cast<int>(record[k.repeat]) : 0;
  study.limit = record.has(k.limit) ? record[k.limit] : 0;
  study.enough = record.has(k.enough) ? record[k.enough] : 0;
  study.vary = build<Vary>(record, "vary", fault, unread);
  for (Truth& each : build<Truth>(record, "reference", fault, unread)) study.truth = std::move(each);
  study.measures = build<Measure>(record, "measure", fault, unread);
  study.charts = build<Chart>(record, "chart", fault, unread);
  if (study.enough > 0 && !study.timed() && !unread.contains("measure"))
    fault(record.where, "enough ends the repetition of timings, but no time is measured");
  for (Measure& m : study.measures) {
    const bool limit = m.against_truth && study.truth && !study.truth->extrapolate.empty();
    m.extrapolated = limit && m.quantity != Quantity::error;
    if (limit && !m.extrapolated)
      fault(m.where, "an extrapolated reference serves errors of a probe or a value, not those of a field");
  }
  study.unread = std::move(unread);
  return study;
}

std::vector<std::string> Study::variables() const {
  std::vector<std::string> names;
  for (const Vary& each : vary) names.insert(names.end(), each.variables.begin(), each.variables.end());
  return names;
}

bool Study::timed() const {
  return std::any_of(measures.begin(), measures.end(), [](const Measure& m) { return m.quantity == Quantity::time; });
}

bool Study::measures_apart() const {
  return std::any_of(measures.begin(), measures.end(),
                     [](const Measure& m) { return m.quantity == Quantity::time && m.what == "apart"; });
}

bool Study::alone() const {
  return timed() || std::any_of(measures.begin(), measures.end(),
                                [](const Measure& m) { return m.quantity == Quantity::memory && m.what == "peak"; });
}

int Study::repetitions() const { return !timed() ? 1 : repeat > 0 ? repeat : 5; }

}  // namespace msml
