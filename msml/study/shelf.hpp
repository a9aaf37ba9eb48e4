// SPDX-License-Identifier: GPL-3.0-or-later
// Results that the runs of a study share in memory.
#pragma once
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "msml/run/run.hpp"

namespace msml {

/// Results by key, kept as long as runs are left that use them, with the reports of each time they were computed. A
/// node that one run is computing is waited for by the others. Safe from any thread.
class SharedResults {
 public:
  /// Says that a run will use these nodes: call once per run before any run starts.
  void expect(const std::vector<std::string>& keys);
  /// Says that the run is over: results that no run expects any more are released.
  void release(const std::vector<std::string>& keys);

  /// True if the result is there with at least `pass` + 1 reports, of which the one of the pass is given; false: the
  /// caller computes it, and calls put().
  bool take(const std::string& key, std::size_t pass, Shelved& into);
  void put(const std::string& key, const Shelved& result);
  /// The outputs, or null.
  const std::vector<Value>* outputs(const std::string& key);
  std::size_t computed() const { return computed_; }  ///< how often a node was computed
  std::size_t shared() const { return shared_; }      ///< how often its result was taken instead

 private:
  struct Entry {
    int users = 0;
    bool busy = false, failed = false;
    std::vector<Value> outputs;
    std::vector<NodeReport> reports;
  };
  std::map<std::string, Entry> entries_;
  std::size_t computed_ = 0, shared_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
};

/// The shelf of one pass over one run. Results of an earlier pass are taken only where `sharing` is on.
class RunShelf final : public Shelf {
 public:
  RunShelf(SharedResults& results, std::vector<std::string> keys, std::size_t pass)
      : results_(results), keys_(std::move(keys)), pass_(pass) {}
  bool take(int node, Shelved& into) override { return results_.take(key(node), pass_, into); }
  void put(int node, const Shelved& result) override { results_.put(key(node), result); }
  const std::vector<Value>* outputs(int node) const { return results_.outputs(key(node)); }

 private:
  const std::string& key(int node) const { return keys_[static_cast<std::size_t>(node)]; }
  SharedResults& results_;
  std::vector<std::string> keys_;
  std::size_t pass_;
};

}  // namespace msml
