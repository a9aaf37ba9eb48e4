// SPDX-License-Identifier: GPL-3.0-or-later
// What the passes of the compiler share while one scene is compiled. Internal to msml/compile.
#pragma once
#include <map>
#include <optional>
#include <set>

#include "msml/compile/compile.hpp"
#include "msml/compile/scope.hpp"
#include "msml/compile/structure.hpp"

namespace msml {

/// A task of the workflow before it is bound. `star` replaces each `*` where the task runs once per file.
struct Task {
  const Tag* tag = nullptr;
  std::string id;
  int node = -1;
  bool mapped = false;
  std::string star_attribute, star_file, star;
};

/// A file that some task writes, and the edge that carries its value.
struct Written {
  Edge edge;
  Location where;
};

struct Work {
  const Document& document;
  const Registry& registry;
  const CompileOptions& options;
  Compilation& out;
  Scope scope;
  std::vector<Task> tasks;
  std::map<std::string, Written> written;                  ///< by target file name as the scene gives it
  std::map<std::pair<std::string, Type>, int> file_nodes;  ///< by path and type
  std::vector<std::string> steps;                          ///< names of the steps
  bool every_tag = true;                                   ///< no tag of the document is unknown or misplaced

  void fault(const Location& where, std::string message) { out.faults.push_back({where, std::move(message)}); }
  void warn(const Location& where, std::string message) {
    (options.strict ? out.faults : out.warnings).push_back({where, std::move(message)});
  }
  void note(const Location& where, std::string message) { out.notes.push_back({where, std::move(message)}); }
  Node& node(int i) { return out.graph.nodes[static_cast<std::size_t>(i)]; }
};

// declare.cpp
void declare_variables(Work& work, const Tag& variables);
/// Gives variables the values of CompileOptions::set; a name that is no variable is a fault.
void apply_settings(Work& work);
void declare_tasks(Work& work, const Tag& workflow);
/// Adds a name to the scope; a name declared before is a fault that names both lines.
bool declare(Work& work, const std::string& name, Named named);
/// Splits the tasks that run once per file, and enters every target file into Work::written.
void declare_targets(Work& work);

// resolve.cpp
/// The text with every ${variable} replaced; nothing if it refers to a task or output, or is malformed.
std::optional<std::string> plain_text(Work& work, const std::string& text);
/// How a message calls the user of a value: "Fill 'liver'".
std::string owner(const Binding& user);
/// The source of an attribute's value; faults are recorded and give an empty value.
Source resolve(Work& work, const Binding& user, const Slot& slot, const std::string& text, const Location& where);
/// As resolve for a known edge: checks the types of both ends.
Source connect(Work& work, const Binding& user, const Slot& slot, Edge edge, const Location& where,
               const std::string& reference);

/// As connect for the edges of a task that runs once per file: only an input that takes a list accepts several.
Source connect_all(Work& work, const Binding& user, const Slot& slot, const std::vector<Edge>& edges,
                   const Location& where, const std::string& reference);

// files.cpp
/// A literal file name or pattern: an edge from the task that writes it, or from a node that reads it from disk.
Source resolve_file(Work& work, const Binding& user, const Slot& slot, const std::string& file,
                    const std::string& logical, const Location& where);
/// Names that match a pattern: targets of tasks and files beside the scene, distinct, in natural order.
std::vector<std::string> matching_files(Work& work, const std::string& pattern);

// bind.cpp
/// Attributes of a tag -> sources; unknown, missing and legacy attributes are reported. Children are not bound.
Binding bind_attributes(Work& work, const Tag& tag);
Binding bind_tree(Work& work, const Tag& tag);  ///< with children
/// A binding with all defaults, for a tag that the scene leaves out.
Binding bind_defaults(const Description& description, const Location& where);
void bind_tasks(Work& work);

// lower.cpp
void declare_objects(Work& work, const Tag& root);
void lower_objects(Work& work, const Tag& root);

// choose.cpp
/// The document without the tags whose condition `when` does not hold: `A = B`, `A != B`, with alternatives `B | C`.
/// The variables of the scene, with the values of CompileOptions::set, may stand in it.
Document choose_tags(const Document& document, const CompileOptions& options, std::vector<Fault>& faults);

// studies.cpp
/// Reads <studies>; names of variables that do not exist, and whatever else makes no sense, are faults.
void read_studies(Work& work, const Tag& root);

// examine.cpp
/// The record of a binding as far as the scene's text says: see Examination.
Record literal_record(const Binding& binding);
/// Asks each operator what makes no sense in its record.
void examine_nodes(Work& work);

// order.cpp
/// Fills Node::needs and Graph::order; cycles are faults that print their path.
void order_nodes(Work& work);

}  // namespace msml
