// SPDX-License-Identifier: GPL-3.0-or-later
// What operators themselves find wrong with a scene before anything runs.
#include "msml/compile/work.hpp"

namespace msml {

Record literal_record(const Binding& binding) {
  Record record{.description = binding.description, .where = binding.where, .id = binding.id, .given = binding.given};
  for (const Source& source : binding.sources) {
    const auto* value = std::get_if<Value>(&source);
    record.values.push_back(value ? *value : Value());
  }
  for (const Binding& child : binding.children) record.children.push_back(literal_record(child));
  return record;
}

void examine_nodes(Work& work) {
  for (const Node& node : work.out.graph.nodes)
    if (node.op && node.op->examiner())
      node.op->examiner()(literal_record(node.args), [&](const Error& error) {
        work.fault(error.where().line > 0 ? error.where() : node.where, error.what());
      });
}

}  // namespace msml
