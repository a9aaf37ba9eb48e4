// SPDX-License-Identifier: GPL-3.0-or-later
// Arguments -> command -> exit code. The only place that catches msml::Error.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "msml/commands/commands.hpp"
#include "msml/commands/help.hpp"
#include "msml/commands/schema.hpp"
#include "msml/commands/study.hpp"
#include "msml/compile/grammar.hpp"
#include "msml/core/address_space.hpp"
#include "operators/registry.hpp"

namespace {

using msml::CompareArguments;
using msml::Registry;
using msml::SceneArguments;

constexpr const char* footer =
    R"(Exit codes: 0 done, 1 comparison above tolerance, 2 bad input, 3 not converged or out of memory, 4 internal fault,
130 interrupted.
Examples:
  msml exec scene.msml.xml -o results     run a scene, write its results to the folder results
  msml check scene.msml.xml               find every fault of a scene without running it
  msml help fixedConstraint               what a tag means and which attributes it takes
  msml compare a.vtu b.vtu --tolerance 1e-6)";

Registry make_registry() {
  Registry registry;
  msml::add_grammar(registry);
  msml::add_operators(registry);
  return registry;
}

/// Everything the command line may say, and which command it names.
struct CommandLine {
  CLI::App app{"msml: one XML scene of soft tissue in, a checked answer out.", "msml"};
  SceneArguments scene;
  CompareArguments compare;
  msml::StudyArguments study;
  msml::ChartArguments chart;
  std::string svg, name, category;
  CLI::App *exec, *check, *show, *help, *list, *schema, *compare_files, *studies, *charts;

  CommandLine() {
    app.set_version_flag("--version", std::string("msml ") + MSML_VERSION);
    app.require_subcommand(1);
    app.footer(footer);
    exec = app.add_subcommand("exec", "run a scene");
    check = app.add_subcommand("check", "compile a scene and report every fault, run nothing");
    show = app.add_subcommand("show", "the graph of a scene as DOT, or as SVG");
    help = app.add_subcommand("help", "explain an operator, material, constraint or any other tag");
    list = app.add_subcommand("list", "list operators, materials, constraints, …");
    schema = app.add_subcommand("schema", "print the XML schema (XSD) of the language");
    studies = app.add_subcommand("study", "run the studies of a scene: tables, charts and a page for each");
    charts = app.add_subcommand("chart", "draw columns of a study's results.csv");
    compare_files = app.add_subcommand("compare", "differences of the fields of two meshes");
    for (CLI::App* each : {exec, check, show}) add_scene_options(each, scene);
    add_scene_options(studies, study.scene);
    add_run_options(exec, scene);
    add_run_options(studies, study.scene);
    add_exec_options();
    add_study_options();
    add_other_options();
  }

  void add_scene_options(CLI::App* command, SceneArguments& to) {
    command->add_option("scene", to.scene, "the scene file (.msml.xml)")->required();
    command->add_option("-o,--output", to.output_folder, "folder for the results (default: the current one)");
    command->add_option("--set", to.set, "name=value: give a variable of the scene another value")
        ->allow_extra_args(false);
    command->add_option("--request", to.requested, "id of a task to run although nothing needs it")
        ->allow_extra_args(false);
    command->add_flag("--strict", to.strict, "warnings about old scenes are errors");
    command->add_flag("-v,--verbose", to.verbose, "notes too");
    command->add_flag("-q,--quiet", to.quiet, "warnings and errors only");
  }

  static void add_run_options(CLI::App* command, SceneArguments& to) {
    command->add_option("-j,--jobs", to.jobs, "nodes (of a study: runs) at once (default: processors)")
        ->check(CLI::Range(1, 256));
    command->add_option("--threads", to.threads, "threads inside a node (default: processors)")
        ->check(CLI::Range(1, 256));
  }

  void add_exec_options() {
    exec->add_flag("-n,--dry-run", scene.dry_run, "print the plan, run nothing");
    exec->add_option("--log-json", scene.log_json, "write the report of the run to this file");
  }

  void add_study_options() {
    studies->add_option("name", study.name, "id of the study (default: all of the scene)");
    studies->add_flag("-n,--dry-run", study.scene.dry_run, "print the runs, run nothing");
    studies->add_flag("--html", study.html, "page and charts in one HTML file too");
    studies->add_flag("--fresh", study.fresh, "run everything anew (default: go on where results.csv ends)");
    studies->add_flag("--keep", study.keep, "keep the files of the runs");
    studies->add_flag("--no-sharing", study.no_sharing, "compute every node of every run, to see what sharing saves");
    charts->add_option("table", chart.table, "results.csv of a study")->required();
    charts->add_option("--chart", chart.chart,
                       "id of a chart of the study: drawn again with the choices below (default: all of its charts, or "
                       "a new one where --x and --y name its columns)");
    charts->add_option("--x", chart.x, "column along the horizontal axis");
    charts->add_option("--y", chart.y, "column along the vertical axis");
    charts->add_option("--color", chart.color, "makes a map of two variables: the error that colours its cells");
    charts->add_option("--accurate", chart.accurate, "of a map: errors up to this are accurate")
        ->check(CLI::PositiveNumber);
    charts->add_option("--wrong", chart.wrong, "of a map: errors above this are wrong results")
        ->check(CLI::PositiveNumber);
    charts->add_option("--theory", chart.theory, "y as a formula in X, a line to draw (may be repeated)")
        ->allow_extra_args(false);
    charts->add_option("--limit", chart.limits, "value of x to be marked (may be repeated)")->allow_extra_args(false);
    charts->add_option("--group", chart.group, "column whose values make the curves (may be repeated)")
        ->allow_extra_args(false);
    charts->add_option("--only", chart.only, "name=value: draw these rows only (may be repeated)")
        ->allow_extra_args(false);
    charts->add_option("--scale", chart.scale, "loglog, linear, logx or logy")
        ->check(CLI::IsMember({"loglog", "linear", "logx", "logy"}));
    charts->add_option("--slope", chart.slopes, "slope to draw as a triangle (may be repeated)")
        ->allow_extra_args(false);
    charts->add_option("--title", chart.title, "above the chart");
    charts->add_option("-o,--output", chart.output, "file without ending (default: the chart's id beside the table)");
  }

  void add_other_options() {
    show->add_option("--to", svg, "file to write, .dot or .svg (default: DOT to the terminal)");
    help->add_option("name", name, "a tag, such as CGALMeshVolumeFromSurface");
    list->add_option("category", category, "operators, materials, constraints, outputs, …");
    compare_files->add_option("a", compare.a, "the mesh that is judged")->required();
    compare_files->add_option("b", compare.b, "the reference")->required();
    compare_files->add_option("--field", compare.fields, "only this field (may be repeated)")->allow_extra_args(false);
    compare_files
        ->add_option("--tolerance", compare.tolerance,
                     "exit 1 if a maximum difference exceeds this share of the reference's largest value")
        ->check(CLI::NonNegativeNumber);
  }

  /// Throws Error for a first word that is no command, with the nearest one.
  void check_command_name(int argc, char** argv) const {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> names;
    std::string known;
    for (const CLI::App* each : app.get_subcommands({})) {
      names.push_back(each->get_name());
      known += (known.empty() ? "" : ", ") + each->get_name();
    }
    const std::string word = argv[1];
    if (std::find(names.begin(), names.end(), word) == names.end())
      throw msml::Error("no command is called " + msml::shortened(word) + msml::did_you_mean(word, names) +
                        "; there are " + known);
  }

  int run(const Registry& registry) {
    study.versions = msml::library_versions();
    if (exec->parsed()) return msml::exec_command(registry, scene);
    if (check->parsed()) return msml::check_command(registry, scene);
    if (studies->parsed()) return msml::study_command(registry, study);
    if (charts->parsed()) return msml::chart_command(chart);
    if (show->parsed()) return msml::show_command(registry, scene, svg);
    if (compare_files->parsed()) {
      compare.has_tolerance = compare_files->count("--tolerance") > 0;
      return msml::compare_command(registry, compare);
    }
    if (help->parsed()) std::fputs((name.empty() ? app.help() : msml::help_text(registry, name)).c_str(), stdout);
    if (list->parsed()) std::fputs(msml::list_text(registry, category).c_str(), stdout);
    if (schema->parsed()) std::fputs(msml::schema_text(registry).c_str(), stdout);
    return 0;
  }
};

/// The exit code; prints what was thrown.
int run_program(int argc, char** argv) {
  try {
    CommandLine line;
    if (argc < 2) {
      std::fputs(line.app.help().c_str(), stderr);
      return static_cast<int>(msml::Failure::input);
    }
    line.check_command_name(argc, argv);
    try {
      line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      const int code = line.app.exit(error);
      return code == 0 ? 0 : static_cast<int>(msml::Failure::input);
    }
    return line.run(make_registry());
  } catch (const msml::Error& error) {
    std::fprintf(stderr, "%s\n", error.str().c_str());
    return static_cast<int>(error.failure());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "not enough memory\n");
    return static_cast<int>(msml::Failure::not_converged);
  } catch (const std::exception& error) {
    const bool crowded = msml::lacks_a_thread(error);
    const std::string told = crowded ? "not enough memory for another thread; try --threads 1 --jobs 1"
                                     : std::string("unexpected: ") + error.what();
    std::fprintf(stderr, "%s\n", told.c_str());
    return static_cast<int>(crowded ? msml::Failure::not_converged : msml::Failure::internal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int code = run_program(argc, argv);
  // The end of a program waits for OpenBLAS's threads, which may still wait for memory.
  if (msml::address_space_is_limited()) {
    std::fflush(nullptr);
    std::_Exit(code);
  }
  return code;
}
