// SPDX-License-Identifier: GPL-3.0-or-later
// Document + Registry -> Graph.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "msml/compile/graph.hpp"
#include "msml/core/registry.hpp"
#include "msml/document/document.hpp"
#include "msml/study/study.hpp"

namespace msml {

struct CompileOptions {
  std::map<std::string, std::string> set;     ///< values of variables given on the command line
  std::filesystem::path output_folder = ".";  ///< to refuse outputs that would overwrite inputs
  bool strict = false;                        ///< warnings about old scenes are faults
};

/// A variable of the scene.
struct VariableInForce {
  std::string value;  ///< its text, that of the command line where one was given
  std::string unit;   ///< of the attribute that it fills, such as "stress" or "1"; "" where none is known
};

/// The graph, or every fault of the scene, sorted by line. The graph is complete only if there are no faults.
struct Compilation {
  Graph graph;
  std::vector<Study> studies;  ///< what `msml study` may run
  std::map<std::string, VariableInForce> variables;
  std::vector<Fault> faults, warnings, notes;
};

/// Resolves references into edges; checks names, types, ranges and required attributes; lowers each object to one node.
/// Reads no data file. `registry` must outlive the graph.
Compilation compile(const Document& document, const Registry& registry, const CompileOptions& options = {});

/// Compiles a scene given as text; `file` is the name used in messages, and its folder the one inputs are looked up in.
/// Faults of the XML come with those of the scene, unless nothing of the scene could be read.
Compilation compile_text(const std::string& text, const std::string& file, const Registry& registry,
                         const CompileOptions& options = {});

/// Reads and compiles a scene file.
Compilation compile_file(const std::filesystem::path& scene, const Registry& registry,
                         const CompileOptions& options = {});

}  // namespace msml
