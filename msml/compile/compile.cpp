// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of the compiler, in order.
#include "msml/compile/compile.hpp"

#include <algorithm>

#include "msml/compile/grammar.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

void sort_by_place(std::vector<Fault>& faults) {
  std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) {
    return std::tie(a.where.file, a.where.line) < std::tie(b.where.file, b.where.line);
  });
  // What stands in the environment is bound once per object: each of its faults counts once.
  std::set<std::pair<int, std::string>> seen;
  std::erase_if(faults, [&](const Fault& fault) { return !seen.insert({fault.where.line, fault.str()}).second; });
}

void keep_variables(Work& work) {
  for (const auto& [name, named] : work.scope)
    if (named.kind == Named::Kind::variable)
      work.out.variables[name] = {named.variable.value, named.variable.ambiguous ? "" : named.variable.unit};
}

void note_unused(Work& work) {
  for (const auto& [name, named] : work.scope)
    if (named.kind == Named::Kind::variable && !named.variable.used)
      work.note(named.where, "the variable " + name + " is not used");
}

/// Tags that only hold others: their attributes have no meaning, but a wrong one is a fault all the same.
void check_holders(Work& work, const Tag& tag) {
  const auto& category = tag.description->category();
  if (category == "operator" || category == "var" || category == "object" || category == "studies") return;
  bind_attributes(work, tag);
  for (const Tag& inner : tag.children) check_holders(work, inner);
}

void read_units(Work& work, const Tag& root) {
  const Tag* environment = root.only("environment");
  if (!environment) return;
  EnvironmentKeys keys;
  describe_environment(keys);
  const Binding binding = bind_attributes(work, *environment);
  const auto* units = std::get_if<Value>(&binding.sources[static_cast<std::size_t>(keys.units.slot)]);
  const auto* text = units ? std::get_if<std::string>(units) : nullptr;
  if (text) work.out.graph.units = *text;
}

void run_passes(Work& work, const Tag& root) {
  if (const Tag* variables = root.only("variables")) declare_variables(work, *variables);
  apply_settings(work);
  if (const Tag* workflow = root.only("workflow")) declare_tasks(work, *workflow);
  declare_objects(work, root);
  declare_targets(work);
  bind_tasks(work);
  lower_objects(work, root);
  read_units(work, root);
  check_holders(work, root);
  read_studies(work, root);
  keep_variables(work);
  note_unused(work);
  order_nodes(work);
  examine_nodes(work);
}

/// `whole`: nothing of the document was lost when it was read.
Compilation compile_known(const Document& document, const Registry& registry, const CompileOptions& options,
                          bool whole) {
  Compilation out;
  out.graph.scene = document.file;
  out.graph.folder = document.folder;
  const Document chosen = choose_tags(document, options, out.faults);
  const Tag root = match_tags(registry, chosen, out.faults);
  if (root.element) {
    Work work{chosen, registry, options, out, {}, {}, {}, {}, {}, whole && out.faults.empty()};
    run_passes(work, root);
  }
  sort_by_place(out.faults);
  sort_by_place(out.warnings);
  sort_by_place(out.notes);
  return out;
}

/// The faults of the document and, where it has a root, those of the scene.
Compilation compile_read(const Document& document, std::vector<Fault> faults, const Registry& registry,
                         const CompileOptions& options) {
  Compilation out;
  if (document.root.tag == "msml") out = compile_known(document, registry, options, faults.empty());
  out.faults.insert(out.faults.end(), std::make_move_iterator(faults.begin()), std::make_move_iterator(faults.end()));
  sort_by_place(out.faults);
  return out;
}

}  // namespace

Compilation compile(const Document& document, const Registry& registry, const CompileOptions& options) {
  return compile_known(document, registry, options, true);
}

Compilation compile_text(const std::string& text, const std::string& file, const Registry& registry,
                         const CompileOptions& options) {
  std::vector<Fault> faults;
  const Document document = parse_document(text, file, faults);
  return compile_read(document, std::move(faults), registry, options);
}

Compilation compile_file(const std::filesystem::path& scene, const Registry& registry, const CompileOptions& options) {
  std::vector<Fault> faults;
  const Document document = read_document(scene, faults);
  return compile_read(document, std::move(faults), registry, options);
}

}  // namespace msml
