// SPDX-License-Identifier: GPL-3.0-or-later
// Carries out one node of the graph.
#include "msml/run/node_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>

#include "msml/compile/scope.hpp"
#include "msml/core/address_space.hpp"
#include "msml/core/atomic_file.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;

class NodeReporter : public Reporter {
 public:
  NodeReporter(int node, Watcher& watcher, NodeReport& report) : node_(node), watcher_(watcher), report_(report) {}
  void progress(double share, const std::string& words) override { watcher_.progress(node_, share, words); }
  void note(const std::string& text) override { watcher_.note(node_, text); }
  void print(const std::string& text) override { watcher_.print(node_, text); }
  void warn(const std::string& text) override {
    {
      const std::lock_guard lock(mutex_);
      report_.warnings.push_back(text);
    }
    watcher_.warning(node_, text);
  }
  void record(const std::string& name, const std::string& json) override {
    const std::lock_guard lock(mutex_);
    report_.facts[name] = json;
  }

 private:
  int node_;
  Watcher& watcher_;
  NodeReport& report_;
  std::mutex mutex_;
};

void check_finite(const std::vector<double>& numbers, const std::string& what) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers[i])) throw Error(fmt::format("value {} of {} is not a finite number", i, what));
}

template <class Geometry>
void check_geometry(const Geometry& geometry) {
  geometry.check();
  for (const auto* fields : {&geometry.point_fields, &geometry.cell_fields})
    for (const Field& field : *fields) check_finite(field.values, "the field " + field.name);
}

/// Data that later nodes and files may rely on: sizes fit, all numbers finite.
void check_output(const Value& value) {
  if (const auto* mesh = std::get_if<MeshPtr>(&value)) check_geometry(**mesh);
  if (const auto* surface = std::get_if<SurfacePtr>(&value)) check_geometry(**surface);
  if (const auto* image = std::get_if<ImagePtr>(&value)) (*image)->check();
  if (const auto* field = std::get_if<FieldPtr>(&value)) check_finite((*field)->values, "the field " + (*field)->name);
  if (const auto* list = std::get_if<std::vector<double>>(&value)) check_finite(*list, "the result");
  if (const auto* number = std::get_if<double>(&value); number && !std::isfinite(*number))
    throw Error("the result is not a finite number");
}

std::string as_text(const Value& value) {
  if (const auto* words = std::get_if<std::string>(&value)) return *words;
  std::string text;
  if (const auto* list = std::get_if<std::vector<double>>(&value))
    for (const double number : *list) text += fmt::format("{}\n", number);
  else if (const auto* integers = std::get_if<std::vector<Integer>>(&value))
    for (const Integer number : *integers) text += fmt::format("{}\n", number);
  else
    text = std::get<std::string>(convert(value, Type::text)) + "\n";
  return text;
}

void write_target(const Value& value, const fs::path& path, const Registry& registry) {
  if (type(value) == Type::nothing) return;
  if (const auto* file = std::get_if<File>(&value)) {
    if (!fs::exists(file->path)) throw Error("no such file: " + file->path.string());
    write_whole(path, [&](const fs::path& temporary) {
      fs::copy_file(file->path, temporary, fs::copy_options::overwrite_existing);
    });
  } else if (!is_data(type(value))) {
    write_whole(path, as_text(value));
  } else {
    registry.write(value, path);
  }
}

class NodeRun {
 public:
  NodeRun(const Graph& graph, int index, const Results& results, const Registry& registry, const RunOptions& options,
          Watcher& watcher, NodeReport& report)
      : graph_(graph),
        node_(graph.nodes[static_cast<std::size_t>(index)]),
        index_(index),
        results_(results),
        registry_(registry),
        options_(options),
        watcher_(watcher),
        report_(report) {}

  std::vector<Value> run() {
    if (node_.kind == NodeKind::file) return {read_file()};
    return node_.each_state >= 0 ? run_each_state() : run_once(record(), "");
  }

 private:
  Record record() const { return gather(graph_, node_.args, results_, options_.output_folder); }

  Value read_file() {
    Value value = registry_.read(node_.file, node_.file_type);
    const auto* mesh = std::get_if<MeshPtr>(&value);
    const bool solid = mesh && ((*mesh)->has(CellKind::tet4) || (*mesh)->has(CellKind::tet10));
    const bool declared_surface = node_.declared == "TriangularSurface" || node_.declared == "SurfaceMesh";
    if (solid && declared_surface) {
      const std::string text = fmt::format("{} is declared as {}, but holds {}; the file wins",
                                           node_.file.filename().string(), node_.declared, (*mesh)->summary());
      report_.warnings.push_back(text);
      watcher_.warning(index_, text);
    }
    report_.summary = summary(value);
    return value;
  }

  std::vector<Value> run_once(const Record& args, const std::string& star) {
    NodeReporter reporter(index_, watcher_, report_);
    Context context(args, reporter, options_.output_folder, options_.threads);
    (*node_.op)(context);
    for (const Value& value : context.outputs) check_output(value);
    for (const Target& target : node_.targets) {
      const fs::path path = options_.output_folder / with_star(target.file.string(), star);
      write_target(context.outputs[static_cast<std::size_t>(target.output)], path, registry_);
      report_.files.push_back(path);
    }
    if (const int first = node_.kind == NodeKind::simulation ? 0 : node_.op->first_output(); first >= 0)
      report_.summary = summary(context.outputs[static_cast<std::size_t>(first)]);
    note_numbers(context.outputs);
    return std::move(context.outputs);
  }

  /// Numbers among the outputs go to the report in full precision.
  void note_numbers(const std::vector<Value>& outputs) {
    const std::vector<Slot>& slots = node_.op->slots();
    std::string text;
    for (std::size_t slot = 0; slot < std::min(slots.size(), outputs.size()); ++slot)
      if (const auto* number = std::get_if<double>(&outputs[slot]); number && slots[slot].role == Role::output)
        text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", slots[slot].name, *number);
    if (!text.empty()) report_.facts["values"] = "{" + text + "}";
  }

  /// The operator once for each state of the series; the outputs are those of the last.
  std::vector<Value> run_each_state() {
    const auto slot = static_cast<std::size_t>(node_.each_state);
    const Edge edge = std::get<Edge>(node_.args.sources[slot]);
    const auto series =
        std::get<SeriesPtr>(results_[static_cast<std::size_t>(edge.node)][static_cast<std::size_t>(edge.slot)]);
    std::vector<Value> outputs;
    Record args = record();
    for (std::size_t i = 0; i < series->files.size(); ++i) {
      args.values[slot] = registry_.read(series->files[i], Type::mesh);
      outputs = run_once(args, fmt::format("{:04}", i));
      watcher_.progress(index_, static_cast<double>(i + 1) / static_cast<double>(series->files.size()),
                        "state by state");
    }
    return outputs;
  }

  const Graph& graph_;
  const Node& node_;
  int index_;
  const Results& results_;
  const Registry& registry_;
  const RunOptions& options_;
  Watcher& watcher_;
  NodeReport& report_;
};

}  // namespace

std::vector<Value> run_node(const Graph& graph, int index, const Results& results, const Registry& registry,
                            const RunOptions& options, Watcher& watcher, NodeReport& report) {
  const Node& node = graph.nodes[static_cast<std::size_t>(index)];
  const auto named = [&](const std::string& what) { return fmt::format("{} '{}': {}", node.tag(), node.id, what); };
  try {
    return NodeRun(graph, index, results, registry, options, watcher, report).run();
  } catch (const Error& error) {
    throw Error(named(error.what()), error.where().file.empty() ? node.where : error.where(), error.failure());
  } catch (const std::bad_alloc&) {
    report.facts["ended"] = R"("out of memory")";
    throw Error(named("not enough memory"), node.where, Failure::not_converged);
  } catch (const std::exception& error) {
    if (!lacks_a_thread(error))
      throw Error(named(std::string("unexpected: ") + error.what()), node.where, Failure::internal);
    report.facts["ended"] = R"("out of memory")";
    throw Error(named("not enough memory for another thread; try --threads 1"), node.where, Failure::not_converged);
  } catch (...) {
    throw Error(named("unexpected failure without a message"), node.where, Failure::internal);
  }
}

}  // namespace msml
