// SPDX-License-Identifier: GPL-3.0-or-later
// What operators themselves find wrong with a scene before anything runs.
#include "msml/compile/work.hpp"

namespace msml {

Record literal_record(const Binding& binding) {
  Record record{.description = binding.description, .where = binding.where, .id = binding.id, .given = binding.given};
  for (std::size_t i = 0; i < binding.sources.size(); ++i) {
    const auto* value = std::get_if<Value>(&binding.sources[i]);
    const bool left_open = binding.misread && !binding.given[i];
    record.values.push_back(value && !left_open ? *value : Value());
    if (left_open) record.given[i] = true;
  }
  for (const Binding& child : binding.children) record.children.push_back(literal_record(child));
  return record;
}

void examine_nodes(Work& work) {
  for (const Node& node : work.out.graph.nodes) {
    if (!node.op || !node.op->examiner() || !node.args.description || node.args.misread) continue;
    const auto at = [&](const Error& error) { return error.where().line > 0 ? error.where() : node.where; };
    const Record record = literal_record(node.args);
    node.op->examiner()({record, work.every_tag, [&](const Error& e) { work.fault(at(e), e.what()); },
                         [&](const Error& e) { work.warn(at(e), e.what()); }});
  }
}

}  // namespace msml
