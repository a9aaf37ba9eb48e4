// SPDX-License-Identifier: GPL-3.0-or-later
// study: runs, tables, charts, pages.
#include "msml/commands/study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>
#include <thread>

#include "msml/core/atomic_file.hpp"
#include "msml/run/interrupt.hpp"
#include "msml/run/program.hpp"
#include "msml/study/chart.hpp"
#include "msml/study/columns.hpp"
#include "msml/study/extrapolate.hpp"
#include "msml/study/page.hpp"
#include "msml/study/refusals.hpp"
#include "msml/study/report.hpp"
#include "msml/study/runner.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const Study& find_study(const std::vector<Study>& studies, const std::string& name, const std::string& scene) {
  std::vector<std::string> names;
  for (const Study& study : studies) {
    if (study.id == name) return study;
    names.push_back(study.id);
  }
  throw Error(fmt::format("no study is called {}{}", shortened(name), did_you_mean(name, names)), {scene, 0});
}

/// One line for a run that is over: "[3/24] tet10, 8: done, error_RMS 0.0123, time_total 0.21".
void print_row(const Study& study, const Table& table, std::size_t row) {
  std::string line = fmt::format("[{}/{}] {}: {}", row + 1, table.rows.size(), table.words(row, study.variables()),
                                 table.text(row, "status"));
  for (const Measure& m : study.measures)
    if (const double value = table.number(row, m.id); std::isfinite(value))
      line += fmt::format(", {} {:.4g}{}{}", m.id, value, m.unit == "s" ? " " : "", m.unit == "s" ? "s" : "");
  if (!table.done(row)) line += ": " + table.text(row, "reason");
  std::fprintf(stderr, "%s\n", line.c_str());
}

Table earlier(const fs::path& file, bool fresh) { return fresh || !fs::exists(file) ? Table{} : read_csv(file); }

/// Draws the charts; what went wrong, by the chart's id. A picture of an earlier session does not stay in its place.
ChartProblems draw_charts(const Study& study, const Table& table, const Compilation& scene, const fs::path& folder) {
  const ChartStyle style{column_labels(study, table, scene), study.combine != Combine::latin_hypercube};
  ChartProblems problems;
  for (const Chart& chart : study.charts) {
    std::string problem;
    try {
      problem = draw(table, chart, style, folder);
    } catch (const Error& error) {
      problem = error.what();
    }
    if (problem.empty()) continue;
    std::fprintf(stderr, "%s: %s\n", chart.where.str().c_str(), problem.c_str());
    problems[chart.id] = problem;
    std::error_code ignored;
    for (const char* ending : {".svg", ".png"}) fs::remove(folder / (chart.id + ending), ignored);
  }
  return problems;
}

/// Errors that stay empty for want of a limit.
void print_missing_limits(const Study& study, Table table) {
  for (const NoLimit& each : extrapolate(study, table))
    std::fprintf(stderr, "%s: no error for %s%s%s: %s\n", study.where.str().c_str(), each.measure.c_str(),
                 each.others.empty() ? "" : " at ", each.others.c_str(), each.why.c_str());
}

class StudyRunner {
 public:
  StudyRunner(const Registry& registry, const StudyArguments& arguments)
      : registry_(registry), arguments_(arguments), document_(read_document(arguments.scene.scene, faults_)) {
    compile_options_ = {settings(arguments.scene.set), arguments.scene.output_folder, arguments.scene.strict};
    compilation_ = compile_file(arguments.scene.scene, registry, compile_options_);
  }

  int run() {
    const Verbosity verbosity = arguments_.scene.quiet     ? Verbosity::quiet
                                : arguments_.scene.verbose ? Verbosity::verbose
                                                           : Verbosity::normal;
    if (!print_messages(compilation_, verbosity)) return static_cast<int>(Failure::input);
    if (compilation_.studies.empty()) throw Error("the scene has no <studies>", {arguments_.scene.scene, 0});
    if (!arguments_.name.empty()) find_study(compilation_.studies, arguments_.name, arguments_.scene.scene);
    std::vector<Chosen> chosen;
    for (const Study& study : compilation_.studies)
      if (arguments_.name.empty() || study.id == arguments_.name)
        chosen.push_back({study, prepare_runs(document_, registry_, compile_options_, study)});
    const int code = all_can_run(chosen) ? 0 : static_cast<int>(Failure::input);
    if (code != 0 && !arguments_.scene.dry_run) return code;
    watch_for_interrupts();
    for (const Chosen& each : chosen) run_one(each.study, each.runs);
    return code;
  }

 private:
  int processors(int wanted) const {
    return wanted > 0 ? wanted : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  }

  /// A study and its runs, prepared before any of them starts.
  struct Chosen {
    const Study& study;
    std::vector<StudyRun> runs;
  };

  /// Tells of the settings that are refused; false if a study has no others.
  static bool all_can_run(const std::vector<Chosen>& chosen) {
    bool good = true;
    for (const Chosen& each : chosen) good = print_refusals(each.study, each.runs) && good;
    return good;
  }

  void run_one(const Study& study, const std::vector<StudyRun>& runs) {
    const Clock::time_point start = Clock::now();
    StudyOptions options{.folder = fs::path(arguments_.scene.output_folder) / study.id,
                         .jobs = processors(arguments_.scene.jobs),
                         .threads = processors(arguments_.scene.threads),
                         .keep = arguments_.keep,
                         .share = !arguments_.no_sharing};
    if (!study.timed() && arguments_.scene.threads == 0) options.threads = 1;  // several runs share the processors
    if (!arguments_.scene.quiet) std::fprintf(stderr, "study %s: %zu runs\n", study.id.c_str(), runs.size());
    if (arguments_.scene.dry_run) return print_plan(runs);
    Sharing sharing;
    const Table table = run_study(
        study, runs, registry_, options, earlier(options.folder / "results.csv", arguments_.fresh),
        [&](const Table& so_far, std::size_t row) {
          if (!arguments_.scene.quiet) print_row(study, so_far, row);
        },
        sharing);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    print_missing_limits(study, table);
    const Session session{.scene = compilation_,
                          .given = compile_options_,
                          .options = options,
                          .fresh = arguments_.fresh,
                          .versions = versions(),
                          .sharing = sharing,
                          .seconds = seconds};
    write_whole(options.folder / "results.json", study_json(study, table, session));
    const ChartProblems problems = draw_charts(study, table, compilation_, options.folder);
    write_page(study, table, options, sharing, seconds, problems);
    if (!arguments_.scene.quiet)
      std::fprintf(stderr, "study %s: %s, %zu nodes computed, %zu taken from other runs; see %s\n", study.id.c_str(),
                   duration(seconds).c_str(), sharing.computed, sharing.shared,
                   (options.folder / "page.md").string().c_str());
  }

  /// The settings of each run, whether it can be carried out, and how many nodes it has of its own.
  static void print_plan(const std::vector<StudyRun>& runs) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      std::string line = fmt::format("[{}/{}]", i + 1, runs.size());
      for (const auto& [name, value] : runs[i].settings) line += fmt::format(" {}={}", name, value);
      if (!runs[i].scene) line += ": refused: " + runs[i].reason;
      std::size_t nodes = 0, own = 0;
      for (const auto& part : {runs[i].scene, runs[i].reference})
        if (part)
          for (const std::string& key : part->used()) ++nodes, own += seen.insert(key).second;
      if (runs[i].scene) line += fmt::format(": {} nodes, {} of them new", nodes, own);
      std::puts(line.c_str());
    }
  }

  /// Of the libraries, and of the program that draws.
  std::map<std::string, std::string> versions() const {
    std::map<std::string, std::string> all = arguments_.versions;
    const std::string gnuplot = program_output({"gnuplot", "--version"});
    all["gnuplot"] = gnuplot.empty() ? "not installed" : gnuplot;
    return all;
  }

  static std::string timing(const Study& study) {
    if (!study.timed()) return "";
    const std::string enough =
        study.enough > 0 ? fmt::format(", of fewer where those took {:g} s (column passes)", study.enough) : "";
    return fmt::format(" Times are medians of {}{}.", study.repetitions(), enough);
  }

  void write_page(const Study& study, const Table& table, const StudyOptions& options, const Sharing& sharing,
                  double seconds, const ChartProblems& problems) const {
    const std::string about = fmt::format(
        "Made by msml {} from {}, on {}, {} thread{}, {} at once.{} This session took {}: {} nodes were computed, {} "
        "results taken from other runs{}.",
        MSML_VERSION, fs::path(arguments_.scene.scene).filename().string(), machine(), options.threads,
        options.threads == 1 ? "" : "s", study.alone() ? "one run" : fmt::format("{} runs", options.jobs),
        timing(study), duration(seconds), sharing.computed, sharing.shared, options.share ? "" : " (sharing is off)");
    const Page page = make_page(study, table, about, problems);
    write_whole(options.folder / "page.md", to_markdown(page));
    if (arguments_.html) write_whole(options.folder / "page.html", to_html(page, options.folder));
  }

  const Registry& registry_;
  const StudyArguments& arguments_;
  std::vector<Fault> faults_;
  Document document_;
  CompileOptions compile_options_;
  Compilation compilation_;
};

}  // namespace

bool print_refusals(const Study& study, const std::vector<StudyRun>& runs) {
  const Refusals found = find_refusals(study, runs);
  if (found.told.message.empty()) return true;
  std::fprintf(stderr, "%s: %s%s\n", found.told.where.str().c_str(),
               found.hopeless() ? "" : "warning: ", found.told.message.c_str());
  return !found.hopeless();
}

int study_command(const Registry& registry, const StudyArguments& arguments) {
  return StudyRunner(registry, arguments).run();
}

}  // namespace msml
