// SPDX-License-Identifier: GPL-3.0-or-later
// exec, check and show.
#include <fmt/format.h>

#include <cstdio>
#include <thread>

#include "msml/commands/commands.hpp"
#include "msml/commands/study.hpp"
#include "msml/core/atomic_file.hpp"
#include "msml/plan/plan.hpp"
#include "msml/run/interrupt.hpp"
#include "msml/run/program.hpp"
#include "msml/run/report.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;

constexpr int bad_input = static_cast<int>(Failure::input);

Verbosity verbosity(const SceneArguments& arguments) {
  return arguments.quiet ? Verbosity::quiet : arguments.verbose ? Verbosity::verbose : Verbosity::normal;
}

Compilation compile_scene(const Registry& registry, const SceneArguments& arguments) {
  return compile_file(arguments.scene, registry, {settings(arguments.set), arguments.output_folder, arguments.strict});
}

int processors(int wanted) {
  return wanted > 0 ? wanted : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Tells of the settings of each study that are refused; false where a study has no others.
bool check_studies(const Registry& registry, const SceneArguments& arguments, const Compilation& compilation) {
  if (compilation.studies.empty()) return true;
  std::vector<Fault> told;
  const Document document = read_document(arguments.scene, told);
  const CompileOptions options{settings(arguments.set), arguments.output_folder, arguments.strict};
  bool good = true;
  for (const Study& study : compilation.studies)
    good = print_refusals(study, prepare_runs(document, registry, options, study)) && good;
  return good;
}

void write_log(const SceneArguments& arguments, const std::string& json) {
  if (!arguments.log_json.empty()) write_whole(fs::path(arguments.log_json), json);
}

void write_svg(const std::string& dot, const fs::path& file) {
  write_whole(file, [&](const fs::path& temporary) {
    const fs::path source = temporary.string() + ".dot";
    write_whole(source, dot);
    const int code = run_program({"dot", "-Tsvg", source.string(), "-o", temporary.string()});
    fs::remove(source);
    if (code != 0) throw Error("cannot draw " + file.string() + ": graphviz (dot) is not installed or failed");
  });
}

}  // namespace

std::map<std::string, std::string> settings(const std::vector<std::string>& set) {
  std::map<std::string, std::string> map;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw Error("--set " + text + " is not of the form name=value");
    map[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return map;
}

bool print_messages(const Compilation& compilation, Verbosity verbosity) {
  const auto print = [](const Fault& fault, const char* kind) {
    std::fprintf(stderr, "%s: %s%s\n", fault.where.str().c_str(), kind, fault.message.c_str());
  };
  if (verbosity == Verbosity::verbose)
    for (const Fault& note : compilation.notes) print(note, "note: ");
  for (const Fault& warning : compilation.warnings) print(warning, "warning: ");
  for (const Fault& fault : compilation.faults) print(fault, "");
  if (compilation.faults.size() > 1) std::fprintf(stderr, "%zu faults\n", compilation.faults.size());
  return compilation.faults.empty();
}

int exec_command(const Registry& registry, const SceneArguments& arguments) {
  const Compilation compilation = compile_scene(registry, arguments);
  if (!print_messages(compilation, verbosity(arguments))) return bad_input;
  const Graph& graph = compilation.graph;
  const Plan plan = make_plan(graph, arguments.requested);
  if (arguments.dry_run) {
    std::fputs(describe(graph, plan).c_str(), stdout);
    return 0;
  }
  if (!arguments.quiet)
    for (const int i : plan.skipped) {
      const Node& node = graph.nodes[static_cast<std::size_t>(i)];
      std::fprintf(stderr, "%s: does not run: %s %s (no output, file target or request needs it)\n",
                   node.where.str().c_str(), node.tag().c_str(), node.id.c_str());
    }
  watch_for_interrupts();
  const RunOptions options{arguments.output_folder, processors(arguments.jobs), processors(arguments.threads)};
  RunResult result;
  {
    Terminal terminal(graph, plan, verbosity(arguments));
    result = run(graph, plan, registry, options, terminal);
  }
  write_output_reports(graph, plan, result, options);
  write_log(arguments, report_json(graph, plan, result, options));
  for (const Error& error : result.errors) std::fprintf(stderr, "%s\n", error.str().c_str());
  if (!arguments.quiet) std::fprintf(stderr, "\n%s\n", summary_table(graph, plan, result).c_str());
  return result.errors.empty() ? 0 : static_cast<int>(result.errors.front().failure());
}

int check_command(const Registry& registry, const SceneArguments& arguments) {
  const Compilation compilation = compile_scene(registry, arguments);
  if (!print_messages(compilation, verbosity(arguments))) return bad_input;
  if (!check_studies(registry, arguments, compilation)) return bad_input;
  const Plan plan = make_plan(compilation.graph, arguments.requested);
  if (!arguments.quiet)
    std::printf("%s: no faults; %zu nodes, %zu run\n", arguments.scene.c_str(), compilation.graph.nodes.size(),
                plan.order.size());
  return 0;
}

int show_command(const Registry& registry, const SceneArguments& arguments, const std::string& file) {
  const Compilation compilation = compile_scene(registry, arguments);
  if (!print_messages(compilation, verbosity(arguments))) return bad_input;
  const std::string dot = to_dot(compilation.graph, make_plan(compilation.graph, arguments.requested).runs);
  if (file.empty())
    std::fputs(dot.c_str(), stdout);
  else if (file.ends_with(".svg"))
    write_svg(dot, file);
  else if (file.ends_with(".dot"))
    write_whole(fs::path(file), dot);
  else
    throw Error(file + " ends in neither .dot nor .svg");
  return 0;
}

}  // namespace msml
