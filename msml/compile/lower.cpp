// SPDX-License-Identifier: GPL-3.0-or-later
// Each <object> becomes one simulation node.
#include <fmt/format.h>

#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

constexpr const char* simulate_tag = "Simulate";

std::vector<const Tag*> objects(const Tag& root) {
  const Tag* scene = root.only("scene");
  return scene ? scene->of_category("object") : std::vector<const Tag*>{};
}

void declare_steps(Work& work, const Tag& root) {
  const Tag* environment = root.only("environment");
  const Tag* simulation = environment ? environment->only("simulation") : nullptr;
  if (!simulation) return;
  std::set<std::string> seen;
  for (const Tag& step : simulation->children) {
    const Attribute* name = step.element->find("name");
    if (!name) continue;
    const std::string text = trimmed(name->value);
    if (!seen.insert(text).second) work.fault(name->where, fmt::format("two steps are named {}", quoted_value(text)));
    work.steps.push_back(text);
  }
}

void declare_outputs(Work& work, const Tag& object, int node) {
  const Tag* output = object.only("outputs");
  if (!output) return;
  for (const Tag& request : output->children) {
    const Attribute* id = request.element->find("id");
    const std::string name = id ? trimmed(id->value) : "";
    Node& simulation = work.node(node);
    const int slot = static_cast<int>(simulation.results.size());
    simulation.results.push_back(name);
    simulation.result_types.push_back(request.description->produces());
    if (id && name.empty())
      work.fault(id->where, fmt::format("the id of {} is empty, but names its files", request.description->tag()));
    else if (name.find_first_of("/${}. \\*\"'<>|") != std::string::npos)
      work.fault(id->where, fmt::format("id = '{}' names files: no blanks, dots, slashes, quotes, braces or *",
                                        quoted_value(name)));
    else
      declare(work, name,
              {.kind = Named::Kind::output, .where = request.element->where, .nodes = {node}, .slot = slot});
  }
}

/// True if some tag inside is unknown, and may be meant for any that seems to be missing.
bool misspelt_inside(const Tag& tag) { return tag.children.size() < tag.element->children.size(); }

/// Adds the tag of a category inside `parent`, bound, or all defaults where the scene leaves it out; nothing where that
/// is not known. An absent parent is one that `root` leaves out.
void add_part(Work& work, const Tag& root, const Tag* parent, const std::string& category, Binding& to) {
  const Tag* part = parent ? parent->only(category) : nullptr;
  if (part) to.children.push_back(bind_tree(work, *part));
  if (part || misspelt_inside(parent ? *parent : root)) return;
  const auto described = work.registry.of_category(category);
  if (described.empty()) throw Error("no description of " + category, {}, Failure::internal);
  to.children.push_back(bind_defaults(*described.front(), to.where));
}

void lower(Work& work, const Tag& object, const Tag& root, int node) {
  Binding body = bind_tree(work, object);
  std::erase_if(body.children, [](const Binding& child) { return child.description->category() == "sets"; });
  const Location& where = object.element->where;
  Node& simulation = work.node(node);
  Binding args = bind_defaults(*simulation.op, where);
  args.id = simulation.id;
  args.children.push_back(std::move(body));
  const Tag* environment = root.only("environment");
  add_part(work, root, environment, "solver", args);
  const std::size_t before = args.children.size();
  add_part(work, root, environment, "simulation", args);
  const Tag* stages = environment ? environment->only("simulation") : nullptr;
  if (args.children.size() > before && args.children.back().children.empty())
    add_part(work, stages ? *stages : root, stages, "step", args.children.back());
  work.node(node).args = std::move(args);  // binding may have added file nodes
}

}  // namespace

void declare_objects(Work& work, const Tag& root) {
  declare_steps(work, root);
  const Operator* op = work.registry.find_operator(simulate_tag);
  std::map<std::string, Location> labels;
  for (const Tag* object : objects(root)) {
    if (!op) {
      work.fault(object->element->where, "this build has no simulation");
      return;
    }
    const Attribute* id = object->element->find("id");
    Node node;
    node.kind = NodeKind::simulation;
    node.where = object->element->where;
    node.op = op;
    node.id = id ? trimmed(id->value) : fmt::format("object_line{}", node.where.line);
    if (const auto [first, fresh] = labels.insert({node.id, node.where}); !fresh)
      work.fault(node.where, fmt::format("two objects are called {}: the other one is at line {}",
                                         quoted_value(node.id), first->second.line));
    work.out.graph.nodes.push_back(std::move(node));
    declare_outputs(work, *object, static_cast<int>(work.out.graph.nodes.size()) - 1);
  }
}

void lower_objects(Work& work, const Tag& root) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < work.out.graph.nodes.size(); ++i)
    if (work.out.graph.nodes[i].kind == NodeKind::simulation) nodes.push_back(static_cast<int>(i));
  const auto bodies = objects(root);
  for (std::size_t i = 0; i < nodes.size() && i < bodies.size(); ++i) lower(work, *bodies[i], root, nodes[i]);
}

}  // namespace msml
