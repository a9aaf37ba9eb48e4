// SPDX-License-Identifier: GPL-3.0-or-later
// Each run of a study, compiled: what it computes, and what it is measured against.
#pragma once
#include <memory>
#include <optional>

#include "msml/compile/compile.hpp"
#include "msml/plan/plan.hpp"

namespace msml {

/// A compiled scene with the nodes that a study needs of it.
struct Prepared {
  Graph graph;
  Plan plan;
  std::vector<std::string> keys;          ///< of all nodes, see node_keys
  std::vector<std::string> used() const;  ///< keys of the nodes that run
};

/// One run. Without a scene it was refused: `reason` says why.
struct StudyRun {
  Settings settings;
  Study study;  ///< with the values of this run filled in
  std::shared_ptr<const Prepared> scene;
  std::shared_ptr<const Prepared> reference;  ///< where errors are taken against another setting
  std::string reason;
  std::string key;  ///< changes with everything that the results depend on
};

/// The output of a graph that a name stands for; ids of tasks may be followed by .output. Nothing if there is none. An
/// empty name: the first series of states, else the first output of a simulation.
std::optional<Edge> find_output(const Graph& graph, const std::string& name);

/// All runs of the study, those that are refused among them. `options` holds what was set on the command line.
std::vector<StudyRun> prepare_runs(const Document& document, const Registry& registry, const CompileOptions& options,
                                   const Study& study);

}  // namespace msml
