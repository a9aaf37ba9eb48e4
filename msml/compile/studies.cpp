// SPDX-License-Identifier: GPL-3.0-or-later
// <studies> -> plain structs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"
#include "msml/study/expand.hpp"
#include "msml/study/units.hpp"

namespace msml {
namespace {

void check_variable(Work& work, const std::string& name, const Location& where) {
  const auto found = work.scope.find(name);
  if (found != work.scope.end() && found->second.kind == Named::Kind::variable) {
    found->second.variable.used = true;
    return;
  }
  std::vector<std::string> names;
  for (const auto& [known, named] : work.scope)
    if (named.kind == Named::Kind::variable) names.push_back(known);
  work.fault(where, fmt::format("the scene has no variable {}{}", quoted_value(name), did_you_mean(name, names)));
}

/// True if a task, an object or a scene output has this name; a task's output may follow a dot.
bool is_node(const Work& work, const std::string& name) {
  const auto& nodes = work.out.graph.nodes;
  const std::string id = name.substr(0, name.find('.'));
  return std::any_of(nodes.begin(), nodes.end(), [&](const Node& node) {
    return node.id == id || std::find(node.results.begin(), node.results.end(), id) != node.results.end();
  });
}

std::vector<std::string> node_names(const Work& work) {
  std::vector<std::string> names;
  for (const Node& node : work.out.graph.nodes) {
    if (!node.id.empty()) names.push_back(node.id);
    names.insert(names.end(), node.results.begin(), node.results.end());
  }
  return names;
}

/// The field of an error that a simulation writes: one of those that `result` knows, and given at nodes.
void check_field(Work& work, const Measure& measure) {
  const auto& nodes = work.out.graph.nodes;
  const bool simulated = measure.of.empty() || std::any_of(nodes.begin(), nodes.end(), [&](const Node& node) {
                           return std::find(node.results.begin(), node.results.end(), measure.of) != node.results.end();
                         });
  const Description* result = work.registry.find("result", {"output"});
  const int slot = result == nullptr ? -1 : result->find("fields");
  if (!simulated || slot < 0 || measure.field == "displacement") return;
  const std::vector<std::string>& known = result->slots()[static_cast<std::size_t>(slot)].choices;
  const auto knows = [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  if (!knows(measure.field))
    work.fault(measure.where, fmt::format("measure '{}': there is no field {}{}", measure.id,
                                          quoted_value(measure.field), did_you_mean(measure.field, known)));
  else if (knows(measure.field + "_nodal"))
    work.fault(measure.where,
               fmt::format("measure '{0}': the field {1} is given at elements, errors are those of nodes: "
                           "take {1}_nodal",
                           measure.id, measure.field));
}

/// The binding with an id in a tree of bindings, or null.
const Binding* find_binding(const Binding& binding, const std::string& id) {
  if (binding.id == id) return &binding;
  for (const Binding& child : binding.children)
    if (const Binding* found = find_binding(child, id)) return found;
  return nullptr;
}

/// The unit of a number that stands in no description of the measure itself: of a field, or of a task's output.
std::string unit_of(const Work& work, const Measure& measure) {
  if (measure.quantity == Quantity::error) return field_unit(measure.field);
  const std::size_t dot = measure.of.find('.');
  for (const Node& node : work.out.graph.nodes) {
    if (measure.quantity == Quantity::probe) {
      const Binding* probe = find_binding(node.args, measure.of);
      const int slot = probe ? probe->description->find("field") : -1;
      const auto* value = slot < 0 ? nullptr : std::get_if<Value>(&probe->sources[static_cast<std::size_t>(slot)]);
      if (const auto* field = value ? std::get_if<std::string>(value) : nullptr) return field_unit(*field);
    } else if (node.id == measure.of.substr(0, dot) && node.op) {
      const int slot =
          dot == std::string::npos ? node.op->first_output() : node.op->find(measure.of.substr(dot + 1), true);
      if (slot >= 0) return node.op->slots()[static_cast<std::size_t>(slot)].unit;
    }
  }
  return {};
}

void check_measure(Work& work, const Study& study, const Measure& measure) {
  if (!measure.of.empty() && !is_node(work, measure.of))
    work.fault(measure.where,
               fmt::format("measure '{}': the scene has no task or output {}{}", quoted_value(measure.id),
                           quoted_value(measure.of), did_you_mean(measure.of, node_names(work))));
  if (measure.quantity == Quantity::error) check_field(work, measure);
  static const std::set<std::string> times{"run",  "apart", "total",    "own",   "simulation",
                                           "step", "setup", "assembly", "linear"};
  if (measure.quantity == Quantity::time && !times.contains(measure.what) && !is_node(work, measure.what)) {
    std::vector<std::string> names = node_names(work);
    names.insert(names.end(), times.begin(), times.end());
    work.fault(
        measure.where,
        fmt::format("time = {} is none of run, apart, total, own, simulation, step, setup, assembly, linear, and "
                    "no task has this id{}",
                    quoted_value(measure.what), did_you_mean(measure.what, names)));
  }
  if (measure.against_truth && !study.truth && !study.unread.contains("reference"))
    work.fault(measure.where, "an error needs a <reference> in the study");
}

void check_chart(Work& work, const Study& study, const Chart& chart) {
  std::vector<std::string> columns = study.variables();
  const std::vector<std::string> variables = columns;
  for (const Measure& measure : study.measures) columns.push_back(measure.id);
  columns.push_back("unknowns");
  const auto known = [&](const std::string& name, const std::vector<std::string>& names, const char* what) {
    if (study.unread.contains("vary") || (&names == &columns && study.unread.contains("measure"))) return;
    if (std::find(names.begin(), names.end(), name) == names.end())
      work.fault(chart.where, fmt::format("{} = {} is no {} of the study{}; it has {}", what, quoted_value(name),
                                          &names == &variables ? "variable" : "column", did_you_mean(name, names),
                                          fmt::join(names, ", ")));
  };
  known(chart.x, columns, "x");
  if (chart.y != share_column) known(chart.y, columns, "y");
  if (!chart.color.empty()) known(chart.color, columns, "color");
  for (const auto& [name, value] : chart.only) known(name, variables, "only");
  for (const std::string& name : chart.group) known(name, variables, "group");
}

void check_extrapolation(Work& work, const Study& study) {
  if (!study.truth || study.truth->extrapolate.empty() || study.unread.contains("vary")) return;
  const std::string& name = study.truth->extrapolate;
  std::set<std::string> values;
  for (const Vary& vary : study.vary)
    for (std::size_t i = 0; i < vary.variables.size(); ++i)
      if (vary.variables[i] == name)
        for (const auto& tuple : vary.values) values.insert(i < tuple.size() ? tuple[i] : "");
  if (study.combine == Combine::latin_hypercube)
    work.fault(study.truth->where,
               "extrapolate needs values from coarse to fine, but combine = latinHypercube draws them");
  else if (values.size() < 3)
    work.fault(study.truth->where,
               fmt::format("extrapolate = {}: no <vary> gives this variable three values or more", quoted_value(name)));
}

void check_study(Work& work, Study& study, const FaultSink& fault) {
  std::set<std::string> columns{"unknowns", "status", "passes", "warnings", "reason", "key", share_column};
  for (const Vary& vary : study.vary)
    for (const std::string& name : vary.variables) {
      check_variable(work, name, vary.where);
      if (!columns.insert(name).second)
        fault(vary.where, fmt::format("{} varies twice, or is the name of another column", quoted_value(name)));
    }
  if (study.truth)
    for (const auto& [name, value] : study.truth->set) check_variable(work, name, study.truth->where);
  if (study.truth && !study.truth->file.empty() && !std::filesystem::exists(work.document.folder / study.truth->file))
    work.fault(study.truth->where, fmt::format("file = {} does not exist", quoted_value(study.truth->file)));
  check_extrapolation(work, study);
  for (const Measure& measure : study.measures) {
    if (!columns.insert(measure.id).second)
      fault(measure.where, fmt::format("two columns are called {}: give one an id", quoted_value(measure.id)));
    check_measure(work, study, measure);
  }
  for (Measure& measure : study.measures) {
    measure.value_unit = unit_of(work, measure);
    if (measure.unit.empty()) measure.unit = measure.value_unit;
  }
  for (const Chart& chart : study.charts) check_chart(work, study, chart);
  if (!study.unread.contains("vary")) expand(study, fault);
}

/// Gives attributes whose value is missing or wrong, which has been told, one that may stand.
void heal(Binding& binding) {
  for (std::size_t i = 0; i < binding.sources.size(); ++i) {
    auto* value = std::get_if<Value>(&binding.sources[i]);
    if (!value || type(*value) != Type::nothing) continue;
    const Slot& slot = binding.description->slots()[i];
    *value = slot.required ? Value(std::string("unnamed")) : slot.fallback;
    binding.given[i] = slot.required;
  }
}

/// The study of a tag with as much of what stands in it as is free of faults of its own.
Study read_study(Work& work, const Tag& tag, const FaultSink& fault) {
  Binding binding = bind_attributes(work, tag);
  heal(binding);
  std::set<std::string> unread;
  for (const Tag& inner : tag.children) {
    const std::size_t before = work.out.faults.size();
    Binding part = bind_tree(work, inner);
    if (work.out.faults.size() == before)
      binding.children.push_back(std::move(part));
    else
      unread.insert(inner.description->category());
  }
  return make_study(literal_record(binding), fault, std::move(unread));
}

}  // namespace

void read_studies(Work& work, const Tag& root) {
  const Tag* studies = root.only("studies");
  if (!studies) return;
  bind_attributes(work, *studies);
  const FaultSink fault = [&](const Location& where, const std::string& what) { work.fault(where, what); };
  std::map<std::string, Location> ids;
  for (const Tag& tag : studies->children) {
    Study study = read_study(work, tag, fault);
    if (study.id.find_first_of("/${}. \\*\"'<>|") != std::string::npos || study.id.empty())
      work.fault(study.where, fmt::format("id = '{}' names a folder: no blanks, dots, slashes, quotes, braces or *",
                                          quoted_value(study.id)));
    if (const auto [first, fresh] = ids.insert({study.id, study.where}); !fresh)
      work.fault(study.where, fmt::format("two studies are called {}: the other one is at line {}",
                                          quoted_value(study.id), first->second.line));
    check_study(work, study, fault);
    work.out.studies.push_back(std::move(study));
  }
}

}  // namespace msml
