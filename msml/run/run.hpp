// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the planned nodes of a graph, independent ones in parallel.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "msml/compile/graph.hpp"
#include "msml/core/registry.hpp"
#include "msml/plan/plan.hpp"

namespace msml {

enum class NodeStatus : std::uint8_t { waiting, done, failed };

/// What is known of a node after the run.
struct NodeReport {
  NodeStatus status = NodeStatus::waiting;
  double seconds = 0;
  bool taken = false;            ///< from a shelf: the time is that of the run that computed it
  std::size_t output_bytes = 0;  ///< held by its values
  std::size_t peak_bytes = 0;    ///< most memory of the whole process while it ran
  std::string summary;           ///< of its first output
  std::vector<std::string> warnings;
  std::map<std::string, std::string> facts;  ///< JSON texts by name, such as "check"
  std::vector<std::filesystem::path> files;  ///< written
};

/// What a node gave, kept for other runs.
struct Shelved {
  std::vector<Value> outputs;
  NodeReport report;
};

/// Outputs of nodes that other runs have computed already. Calls come from any thread.
class Shelf {
 public:
  virtual ~Shelf() = default;
  /// Fills `into` if the node need not run.
  virtual bool take(int node, Shelved& into) = 0;
  /// Told of every node that has run, failed ones too.
  virtual void put(int node, const Shelved& result) = 0;
};

/// Told what happens while nodes run; calls come from any thread. An Error thrown by started or progress ends the node.
class Watcher {
 public:
  virtual ~Watcher() = default;
  virtual void started(int node) = 0;
  virtual void progress(int node, double share, const std::string& words) = 0;
  virtual void finished(int node, const NodeReport& report) = 0;
  virtual void note(int node, const std::string& text) = 0;
  virtual void warning(int node, const std::string& text) = 0;
  virtual void print(int node, const std::string& text) = 0;
};

struct RunOptions {
  std::filesystem::path output_folder = ".";
  int jobs = 1;            ///< nodes at once
  int threads = 1;         ///< threads inside a node
  Shelf* shelf = nullptr;  ///< of results that runs share; null: every node runs
};

/// How a run ended: one report per node of the graph, and the first error if a node failed.
struct RunResult {
  std::vector<NodeReport> nodes;
  std::vector<Error> errors;  ///< at most one per failed node
  double seconds = 0;
  std::size_t bare_bytes = 0;  ///< memory of the process before its first node, and of code that nodes used
};

RunResult run(const Graph& graph, const Plan& plan, const Registry& registry, const RunOptions& options,
              Watcher& watcher);

}  // namespace msml
