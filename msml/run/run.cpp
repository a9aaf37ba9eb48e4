// SPDX-License-Identifier: GPL-3.0-or-later
// The scheduler: a ready node goes to the next free worker.
#include "msml/run/run.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "msml/run/memory.hpp"
#include "msml/run/node_run.hpp"

namespace msml {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Scheduler {
 public:
  Scheduler(const Graph& graph, const Plan& plan, const Registry& registry, const RunOptions& options, Watcher& watcher)
      : graph_(graph),
        plan_(plan),
        registry_(registry),
        options_(options),
        watcher_(watcher),
        results_(graph.nodes.size()),
        users_(graph.nodes.size(), 0),
        open_(graph.nodes.size(), 0) {
    result_.nodes.resize(graph.nodes.size());
    for (std::size_t position = 0; position < plan.order.size(); ++position) {
      const int node = plan.order[position];
      open_[at(node)] = graph.nodes[at(node)].needs.size();
      for (const int need : graph.nodes[at(node)].needs) ++users_[at(need)];
      if (open_[at(node)] == 0) ready_.insert(node);
    }
    left_ = plan.order.size();
  }

  RunResult run() {
    const Clock::time_point start = Clock::now();
    const std::size_t before = own_memory();
    const int workers = std::max(1, std::min<int>(options_.jobs, static_cast<int>(plan_.order.size())));
    {
      std::vector<std::jthread> others;
      for (int i = 1; i < workers; ++i) others.emplace_back([this] { work(); });
      work();
    }
    result_.bare_bytes = before + program_memory();
    result_.seconds = seconds_since(start);
    return std::move(result_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// Takes ready nodes, the earliest in the scene first, until none is left or one has failed.
  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return !ready_.empty() || left_ == 0 || stopped(); });
      if (left_ == 0 || stopped()) return;
      const int node = *ready_.begin();
      ready_.erase(ready_.begin());
      if (running_++ == 0) reset_peak_memory();
      lock.unlock();
      run_one(node);
      lock.lock();
      --running_;
      settle(node);
      changed_.notify_all();
    }
  }

  bool stopped() const { return !result_.errors.empty(); }

  void run_one(int node) {
    NodeReport& report = result_.nodes[at(node)];
    if (from_shelf(node, report)) return;
    const Clock::time_point start = Clock::now();
    try {
      watcher_.started(node);
      results_[at(node)] = run_node(graph_, node, results_, registry_, options_, watcher_, report);
      report.status = NodeStatus::done;
    } catch (const Error& error) {
      report.status = NodeStatus::failed;
      const std::lock_guard lock(mutex_);
      result_.errors.push_back(error);
    }
    report.seconds = seconds_since(start);
    report.peak_bytes = peak_memory();
    for (const Value& value : results_[at(node)]) report.output_bytes += bytes(value);
    if (options_.shelf) options_.shelf->put(node, {results_[at(node)], report});
    watcher_.finished(node, report);
  }

  bool from_shelf(int node, NodeReport& report) {
    Shelved shelved;
    if (!options_.shelf || !options_.shelf->take(node, shelved)) return false;
    results_[at(node)] = std::move(shelved.outputs);
    report = std::move(shelved.report);
    report.taken = true;
    return true;
  }

  /// Opens the users of a finished node and releases the values that no one needs any more. Holds the lock.
  void settle(int node) {
    --left_;
    if (result_.nodes[at(node)].status != NodeStatus::done) return;
    for (const int user : plan_.order) {
      const auto& needs = graph_.nodes[at(user)].needs;
      if (std::binary_search(needs.begin(), needs.end(), node) && --open_[at(user)] == 0) ready_.insert(user);
    }
    for (const int need : graph_.nodes[at(node)].needs)
      if (--users_[at(need)] == 0) results_[at(need)].clear();
    if (users_[at(node)] == 0) results_[at(node)].clear();
  }

  const Graph& graph_;
  const Plan& plan_;
  const Registry& registry_;
  const RunOptions& options_;
  Watcher& watcher_;
  Results results_;
  std::vector<std::size_t> users_, open_;
  std::set<int> ready_;
  std::size_t left_ = 0;
  int running_ = 0;
  RunResult result_;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace

RunResult run(const Graph& graph, const Plan& plan, const Registry& registry, const RunOptions& options,
              Watcher& watcher) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(1, options.threads)));
  return Scheduler(graph, plan, registry, options, watcher).run();
}

}  // namespace msml
