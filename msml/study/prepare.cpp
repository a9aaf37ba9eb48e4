// SPDX-License-Identifier: GPL-3.0-or-later
// Settings -> compiled scenes.
#include "msml/study/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "msml/study/expand.hpp"
#include "msml/study/keys.hpp"

namespace msml {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Files that tasks write are no results of a study: only those stay that another node reads.
void drop_targets(Graph& graph) {
  std::vector<bool> read(graph.nodes.size(), false);
  const auto look = [&](const auto& self, const Binding& binding) -> void {
    for (std::size_t i = 0; i < binding.sources.size(); ++i)
      if (const auto* edge = std::get_if<Edge>(&binding.sources[i]))
        read[at(edge->node)] = read[at(edge->node)] || binding.description->slots()[i].type == Type::file;
    for (const Binding& child : binding.children) self(self, child);
  };
  for (const Node& node : graph.nodes) look(look, node.args);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (!read[i] && graph.nodes[i].each_state < 0) graph.nodes[i].targets.clear();
}

/// The nodes that the measures look at; empty: the whole scene counts.
std::vector<int> measured_nodes(const Graph& graph, const Study& study) {
  std::vector<int> nodes;
  const auto add = [&](const std::string& name) {
    if (const auto edge = find_output(graph, name)) nodes.push_back(edge->node);
  };
  for (const Measure& measure : study.measures) {
    add(measure.of);
    if (measure.quantity == Quantity::time) add(measure.what);
  }
  return nodes;
}

std::shared_ptr<const Prepared> prepared(Graph graph, const std::vector<int>& nodes) {
  drop_targets(graph);
  const auto found = std::make_shared<Prepared>();
  found->graph = std::move(graph);
  found->plan = nodes.empty() ? make_plan(found->graph) : plan_for(found->graph, nodes);
  found->keys = node_keys(found->graph);
  return found;
}

/// Tells one build of the program from another: what an older one found and timed does not count. "" where unknown.
std::string this_program() {
  const std::filesystem::path self = "/proc/self/exe";  // Linux, proc(5)
  std::error_code code;
  const auto size = std::filesystem::file_size(self, code);
  const auto time = std::filesystem::last_write_time(self, code).time_since_epoch().count();
  return code ? "" : fmt::format("{} {}", size, time);
}

class Preparation {
 public:
  Preparation(const Document& document, const Registry& registry, const CompileOptions& options, const Study& study)
      : document_(document), registry_(registry), options_(options), study_(study) {}

  StudyRun run(const Settings& settings) {
    StudyRun run{.settings = settings, .study = study_, .scene = {}, .reference = {}, .reason = {}, .key = {}};
    Compilation compilation = compiled(settings);
    std::string key =
        fmt::format("{} {} {} {} {}", MSML_VERSION, program_, study_.repetitions(), study_.enough, study_.limit);
    for (const auto& [name, value] : settings) key += fmt::format(" {}={}", name, value);
    if (const std::string fault = first_fault(compilation); !fault.empty()) {
      run.reason = fault;
    } else {
      run.study = *std::find_if(compilation.studies.begin(), compilation.studies.end(),
                                [&](const Study& each) { return each.id == study_.id; });
      const std::vector<int> nodes = measured_nodes(compilation.graph, run.study);
      run.scene = prepared(std::move(compilation.graph), nodes);
      if (run.study.truth) add_reference(run);
    }
    for (const auto& part : {run.scene, run.reference})
      if (part)
        for (const std::string& used : part->used()) key += used;
    run.key = hash(key + truth_key(run.study) + run.reason).substr(0, 16);
    return run;
  }

 private:
  Compilation compiled(const Settings& settings) const {
    CompileOptions options = options_;
    for (const auto& [name, value] : settings) options.set[name] = value;
    return compile(document_, registry_, options);
  }

  static std::string first_fault(const Compilation& compilation) {
    const std::size_t count = compilation.faults.size();
    return count == 0 ? ""
                      : compilation.faults.front().str() + (count > 1 ? fmt::format(" (and {} more)", count - 1) : "");
  }

  /// References of several runs are often the same: each is compiled once.
  void add_reference(StudyRun& run) {
    if (run.study.truth->set.empty()) return;
    Settings settings = run.settings;
    for (const auto& setting : run.study.truth->set) {
      const auto same =
          std::find_if(settings.begin(), settings.end(), [&](const auto& each) { return each.first == setting.first; });
      if (same == settings.end())
        settings.push_back(setting);
      else
        same->second = setting.second;
    }
    std::shared_ptr<const Prepared>& known = references_[settings];
    if (!known) {
      Compilation compilation = compiled(settings);
      if (const std::string fault = first_fault(compilation); !fault.empty()) {
        run.reason = "the reference: " + fault;
        run.scene = {};
        return;
      }
      const std::vector<int> nodes = compared_nodes(compilation.graph, run.study);
      known = prepared(std::move(compilation.graph), nodes);
    }
    run.reference = known;
  }

  static std::vector<int> compared_nodes(const Graph& graph, const Study& study) {
    std::vector<int> nodes;
    for (const Measure& measure : study.measures)
      if (const auto edge = find_output(graph, measure.of); edge && measure.against_truth) nodes.push_back(edge->node);
    return nodes;
  }

  /// What tells a file from what it was before.
  std::string stamp(const std::string& file) const {
    if (file.empty()) return {};
    std::error_code code;
    const auto path = document_.folder / file;
    return fmt::format(" {} {}", std::filesystem::file_size(path, code),
                       std::filesystem::last_write_time(path, code).time_since_epoch().count());
  }

  std::string truth_key(const Study& study) const {
    std::string key;
    if (study.truth) {
      key =
          fmt::format("{} {} {}", study.truth->file, study.truth->time, study.truth->limit) + stamp(study.truth->file);
      for (const Formula& formula : study.truth->expected) key += fmt::format(" {} {}", formula.text, formula.number);
    }
    for (const Measure& m : study.measures)
      key += fmt::format(" {} {} {} {} {} {}", static_cast<int>(m.quantity), m.id, m.what, m.field, m.of, m.relative);
    return key;
  }

  const Document& document_;
  const Registry& registry_;
  const CompileOptions& options_;
  const Study& study_;
  const std::string program_ = this_program();
  std::map<Settings, std::shared_ptr<const Prepared>> references_;
};

}  // namespace

std::vector<std::string> Prepared::used() const {
  std::vector<std::string> some;
  for (const int node : plan.order) some.push_back(keys[at(node)]);
  return some;
}

std::optional<Edge> find_output(const Graph& graph, const std::string& name) {
  const std::size_t dot = name.find('.');
  const std::string id = name.substr(0, dot), slot = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const Node& node = graph.nodes[n];
    for (std::size_t i = 0; i < node.results.size(); ++i)
      if (name.empty() ? node.result_types[i] == Type::series : node.results[i] == name)
        return Edge{static_cast<int>(n), static_cast<int>(i)};
    if (name.empty() || node.id != id || node.kind == NodeKind::file) continue;
    const int output = slot.empty() ? node.op->first_output() : node.op->find(slot, true);
    return Edge{static_cast<int>(n), output};
  }
  if (name.empty())
    for (std::size_t n = 0; n < graph.nodes.size(); ++n)
      if (graph.nodes[n].kind == NodeKind::simulation) return Edge{static_cast<int>(n), 0};
  return std::nullopt;
}

std::vector<StudyRun> prepare_runs(const Document& document, const Registry& registry, const CompileOptions& options,
                                   const Study& study) {
  Preparation preparation(document, registry, options, study);
  std::vector<StudyRun> runs;
  for (const Settings& settings :
       expand(study, [](const Location&where, const std::string&what) { throw Error(what, where); }))
    runs.push_back(preparation.run(settings));
  return runs;
}

}  // namespace msml
