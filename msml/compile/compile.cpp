// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of the compiler, in order.
#include "msml/compile/compile.hpp"

#include <algorithm>

#include "msml/compile/work.hpp"

namespace msml {
namespace {

void sort_by_place(std::vector<Fault>& faults) {
  std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) {
    return std::tie(a.where.file, a.where.line) < std::tie(b.where.file, b.where.line);
  });
  const auto same = [](const Fault& a, const Fault& b) { return a.where == b.where && a.message == b.message; };
  faults.erase(std::unique(faults.begin(), faults.end(), same), faults.end());
}

void note_unused(Work& work) {
  for (const auto& [name, named] : work.scope)
    if (named.kind == Named::Kind::variable && !named.variable.used)
      work.note(named.where, "the variable " + name + " is not used");
}

void run_passes(Work& work, const Tag& root) {
  if (const Tag* variables = root.only("variables")) declare_variables(work, *variables);
  if (const Tag* workflow = root.only("workflow")) declare_tasks(work, *workflow);
  declare_objects(work, root);
  declare_targets(work);
  bind_tasks(work);
  lower_objects(work, root);
  note_unused(work);
  if (work.out.faults.empty()) order_nodes(work);
}

}  // namespace

Compilation compile(const Document& document, const Registry& registry, const CompileOptions& options) {
  Compilation out;
  out.graph.scene = document.file;
  out.graph.folder = document.folder;
  const Tag root = match_tags(registry, document, out.faults);
  if (root.element) {
    Work work{document, registry, options, out, {}, {}, {}, {}, {}};
    run_passes(work, root);
  }
  sort_by_place(out.faults);
  sort_by_place(out.warnings);
  sort_by_place(out.notes);
  return out;
}

Compilation compile_file(const std::filesystem::path& scene, const Registry& registry, const CompileOptions& options) {
  std::vector<Fault> faults;
  const Document document = read_document(scene, faults);
  if (!faults.empty()) {
    Compilation out;
    out.faults = std::move(faults);
    sort_by_place(out.faults);
    return out;
  }
  return compile(document, registry, options);
}

}  // namespace msml
