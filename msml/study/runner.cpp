// SPDX-License-Identifier: GPL-3.0-or-later
// Runs, one after another where time is measured, else several at once.
#include "msml/study/runner.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "msml/core/atomic_file.hpp"
#include "msml/study/extrapolate.hpp"
#include "msml/study/measure.hpp"
#include "msml/study/pinned.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

Error beyond(double limit) {
  return Error(fmt::format("ended after its limit of {} s", limit), {}, Failure::interrupted);
}

/// Ends a run that takes longer than its limit, before the next node or the next time it reports progress.
class Stopwatch final : public Watcher {
 public:
  explicit Stopwatch(double limit) : limit_(limit) {}
  void started(int) override { look(); }
  void progress(int, double, const std::string&) override { look(); }
  void finished(int, const NodeReport&) override {}
  void note(int, const std::string&) override {}
  void warning(int, const std::string&) override {}
  void print(int, const std::string&) override {}

 private:
  void look() const {
    if (limit_ > 0 && std::chrono::duration<double>(Clock::now() - start_).count() > limit_) throw beyond(limit_);
  }

  double limit_;
  Clock::time_point start_ = Clock::now();
};

const std::string reference_failed = "the reference: ";

const char* status_of(const Error& error) {
  switch (error.failure()) {
    case Failure::input:
      return "refused";
    case Failure::not_converged:
      return "not converged";
    case Failure::interrupted:
      return "limit";
    default:
      return "failed";
  }
}

/// A run whose node noted that it ended for want of memory.
bool ran_out_of_memory(const RunResult& result) {
  for (const NodeReport& node : result.nodes) {
    if (node.status != NodeStatus::failed) continue;
    if (node.facts.contains("ended")) return true;
    const auto check = node.facts.find("check");
    if (check == node.facts.end()) continue;
    const auto json = nlohmann::json::parse(check->second, nullptr, false);
    if (json.is_object() && json.value("ended", "") == "out of memory") return true;
  }
  return false;
}

std::string warnings_of(const RunResult& result) {
  std::string text;
  for (const NodeReport& node : result.nodes)
    for (const std::string& warning : node.warnings) text += (text.empty() ? "" : "; ") + warning;
  return text;
}

/// What simulations note in their check under "recoveries".
std::string recoveries_of(const RunResult& result) {
  std::string text;
  for (const NodeReport& node : result.nodes) {
    const auto check = node.facts.find("check");
    if (check == node.facts.end()) continue;
    const auto json = nlohmann::json::parse(check->second, nullptr, false);
    if (!json.is_object()) continue;
    for (const auto& each : json.value("recoveries", nlohmann::json::array()))
      if (each.is_string()) text += (text.empty() ? "" : "; ") + each.get<std::string>();
  }
  return text;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::string digits(double x) { return fmt::format("{:.10g}", x); }

/// Times of another number of threads, or taken without sharing, are not those that are asked for.
std::string key_of(const StudyRun& run, const Study& study, const StudyOptions& options) {
  return study.timed() ? fmt::format("{}-{}{}", run.key, options.threads, options.share ? "" : "-apart") : run.key;
}

class Runner {
 public:
  Runner(const Study& study, const Registry& registry, const StudyOptions& options, SharedResults& results)
      : study_(study), registry_(registry), options_(options), results_(results) {}

  /// The cells of a run, and whether a limit ended it or its reference.
  struct Told {
    std::vector<std::string> cells;
    bool beyond_limit = false;
  };

  Told row(const StudyRun& run, std::size_t number) {
    Told told;
    Row row{.status = "refused",
            .reason = run.reason,
            .warnings = {},
            .recovered = {},
            .unknowns = {},
            .passes = 0,
            .samples = {}};
    row.samples.resize(study_.measures.size());
    if (run.scene) {
      try {
        carry_out(run, options_.folder / "runs" / fmt::format("{:04}", number), row);
        row.status = "done";
      } catch (const Error& error) {
        row.status = std::string(error.what()).starts_with(reference_failed) ? "no reference" : status_of(error);
        row.reason = error.str();
        told.beyond_limit = error.failure() == Failure::interrupted;
      } catch (const std::bad_alloc&) {
        row.no_memory = true;
        row.reason = "not enough memory to measure the run";
      }
      if (row.no_memory) row.status = "out of memory";
    }
    told.cells = cells(run, row);
    return told;
  }

  /// From now on no run waits for another: a reference that has no time now never has.
  void one_by_one() { one_by_one_ = true; }

  std::size_t computed_apart() const { return apart_; }

 private:
  struct Row {
    std::string status, reason, warnings, recovered;
    std::optional<double> unknowns;
    bool no_memory = false;
    int passes = 0;                            ///< that were measured
    std::vector<std::vector<double>> samples;  ///< per measure, one per pass
  };

  void carry_out(const StudyRun& run, const fs::path& folder, Row& row) {
    std::optional<RunShelf> truth_shelf;
    std::optional<RunResult> truth;
    if (run.reference) {
      truth_shelf.emplace(results_, run.reference->keys, 0);
      truth = reference_result(*run.reference, *truth_shelf, folder / "reference",
                               run.study.truth->limit > 0 ? run.study.truth->limit : study_.limit);
    }
    double spent = 0;
    for (int repetition = 0; repetition < study_.repetitions(); ++repetition) {
      if (repetition > 0 && study_.enough > 0 && spent >= study_.enough) break;
      RunShelf shelf(results_, run.scene->keys, static_cast<std::size_t>(repetition));
      const RunResult result = pass(*run.scene, shelf, folder, study_.limit);
      spent += result.seconds;
      row.unknowns = unknowns({*run.scene, result, shelf});
      row.warnings = warnings_of(result);
      row.recovered = recoveries_of(result);
      row.no_memory = ran_out_of_memory(result);
      if (!result.errors.empty()) throw result.errors.front();
      const Finished finished{*run.scene, result, shelf, study_.measures_apart() ? apart(run, folder) : 0};
      spent += finished.apart_seconds;
      std::optional<Finished> reference;
      if (truth) reference.emplace(Finished{*run.reference, *truth, *truth_shelf});
      for (std::size_t i = 0; i < run.study.measures.size(); ++i)
        if (repetition == 0 || run.study.measures[i].quantity == Quantity::time)
          row.samples[i].push_back(
              measure(run.study.measures[i], run, finished, reference ? &*reference : nullptr, registry_));
      ++row.passes;
    }
  }

  /// Seconds of a pass that takes nothing from other runs and leaves them nothing.
  double apart(const StudyRun& run, const fs::path& folder) {
    SharedResults own;
    RunShelf shelf(own, run.scene->keys, 0);
    const RunResult result = pass(*run.scene, shelf, folder / "apart", study_.limit);
    apart_ += own.computed();
    if (!result.errors.empty()) throw result.errors.front();
    return result.seconds;
  }

  /// A reference that failed once is not tried again for the next run.
  RunResult reference_result(const Prepared& reference, RunShelf& shelf, const fs::path& folder, double limit) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto known = failed_.find(&reference); known != failed_.end())
        throw Error(known->second, {}, Failure::internal);
    }
    RunResult result = pass(reference, shelf, folder, limit);
    if (result.errors.empty()) return result;
    const Error& error = result.errors.front();
    const std::string why = reference_failed + error.str();
    const std::lock_guard lock(mutex_);
    if (one_by_one_ || error.failure() != Failure::interrupted) failed_[&reference] = why;
    throw Error(why, {}, error.failure());
  }

  RunResult pass(const Prepared& scene, RunShelf& shelf, const fs::path& folder, double limit) {
    const WithoutFlushing scratch;         // a run is made again sooner than a disk has taken it
    if (study_.timed()) ::malloc_trim(0);  // what runs before have left is not of this one's peak
    Stopwatch watch(limit);
    RunResult result = msml::run(scene.graph, scene.plan, registry_, {folder, 1, options_.threads, &shelf}, watch);
    if (result.errors.empty() && limit > 0 && result.seconds > limit) result.errors.push_back(beyond(limit));
    return result;
  }

  std::vector<std::string> cells(const StudyRun& run, const Row& row) const {
    std::vector<std::string> cells;
    for (const auto& [name, value] : run.settings) cells.push_back(value);
    cells.push_back(row.status);
    cells.push_back(row.unknowns ? digits(*row.unknowns) : "");
    if (study_.timed()) cells.push_back(std::to_string(row.passes));
    for (std::size_t i = 0; i < study_.measures.size(); ++i) {
      const auto& samples = row.samples[i];
      const bool timed = study_.measures[i].quantity == Quantity::time;
      if (samples.empty()) {
        cells.insert(cells.end(), timed ? 3 : study_.measures[i].extrapolated ? 2 : 1, "");
        continue;
      }
      if (study_.measures[i].extrapolated) cells.emplace_back();  // filled once all runs are over
      cells.push_back(digits(median(samples)));
      if (!timed) continue;
      cells.push_back(digits(*std::min_element(samples.begin(), samples.end())));
      cells.push_back(digits(*std::max_element(samples.begin(), samples.end())));
    }
    cells.push_back(row.warnings);
    cells.push_back(row.recovered);
    cells.push_back(row.reason);
    cells.push_back(key_of(run, study_, options_));
    return cells;
  }

  const Study& study_;
  const Registry& registry_;
  const StudyOptions& options_;
  SharedResults& results_;
  std::atomic<bool> one_by_one_ = false;
  std::mutex mutex_;
  std::map<const Prepared*, std::string> failed_;  ///< references, and why
  std::atomic<std::size_t> apart_ = 0;             ///< nodes computed in runs that share nothing
};

/// The row of an earlier session with this key, or null.
const std::vector<std::string>* known_row(const Table& known, const std::vector<std::string>& columns,
                                          const std::string& key) {
  if (known.columns != columns) return nullptr;
  for (const auto& row : known.rows)
    if (row.back() == key) return &row;
  return nullptr;
}

/// The runs as they are, or with keys of their own where nothing is to be shared.
std::vector<StudyRun> apart(std::vector<StudyRun> runs, bool share) {
  for (std::size_t i = 0; i < runs.size() && !share; ++i)
    if (runs[i].scene) {
      auto own = std::make_shared<Prepared>(*runs[i].scene);
      for (std::string& key : own->keys) key += fmt::format(" {}", i);
      runs[i].scene = own;
    }
  return runs;
}

/// The nodes that a run keeps in memory, its own and those of its reference.
std::vector<std::string> all_used(const StudyRun& run) {
  std::vector<std::string> keys = run.scene ? run.scene->used() : std::vector<std::string>{};
  if (run.scene && run.reference)
    for (const std::string& key : run.reference->used()) keys.push_back(key);
  return keys;
}

}  // namespace

std::vector<std::string> study_columns(const Study& study) {
  std::vector<std::string> columns = study.variables();
  columns.insert(columns.end(), {"status", "unknowns"});
  if (study.timed()) columns.emplace_back("passes");
  for (const Measure& each : study.measures) {
    columns.push_back(each.id);
    if (each.quantity == Quantity::time) columns.insert(columns.end(), {each.id + "_low", each.id + "_high"});
    if (each.extrapolated) columns.push_back(each.id + "_value");
  }
  columns.insert(columns.end(), {"warnings", "recovered", "reason", "key"});
  return columns;
}

Table run_study(const Study& study, const std::vector<StudyRun>& all_runs, const Registry& registry,
                const StudyOptions& options, const Table& known, const RowSink& sink, Sharing& sharing) {
  std::optional<Pinned> pinned;
  if (study.timed()) pinned.emplace(options.threads);
  const std::vector<StudyRun> runs = apart(all_runs, options.share);
  Table table{study_columns(study), std::vector<std::vector<std::string>>(runs.size())};
  std::vector<std::size_t> open;
  SharedResults results;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (const auto* row = known_row(known, table.columns, key_of(runs[i], study, options)))
      table.rows[i] = *row;
    else
      open.push_back(i), results.expect(all_used(runs[i]));
  }
  Runner runner(study, registry, options, results);
  std::mutex mutex;
  std::atomic<std::size_t> next = 0;
  const bool alone = study.alone() || options.jobs < 2;
  if (alone) runner.one_by_one();
  std::vector<std::size_t> late;
  const auto keep = [&](std::size_t run, std::vector<std::string> row) {
    results.release(all_used(runs[run]));
    table.rows[run] = std::move(row);
    Table so_far{table.columns, {}};
    for (const auto& each : table.rows)
      if (!each.empty()) so_far.rows.push_back(each);
    write_whole(options.folder / "results.csv", to_csv(so_far));
    sink(table, run);
  };
  const auto work = [&] {
    for (std::size_t i = next++; i < open.size(); i = next++) {
      Runner::Told row = runner.row(runs[open[i]], open[i]);
      const std::lock_guard lock(mutex);
      if (!alone && row.beyond_limit)
        late.push_back(open[i]);  // it may have waited for another: once more, by itself
      else
        keep(open[i], std::move(row.cells));
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < (alone ? 1 : options.jobs); ++i) others.emplace_back(work);
    work();
  }
  std::sort(late.begin(), late.end());
  runner.one_by_one();
  for (const std::size_t i : late) keep(i, runner.row(runs[i], i).cells);
  extrapolate(study, table);
  write_whole(options.folder / "results.csv", to_csv(table));
  if (!options.keep) {
    std::error_code ignored;
    fs::remove_all(options.folder / "runs", ignored);
  }
  sharing = {results.computed(), results.shared(), runner.computed_apart()};
  return table;
}

}  // namespace msml
