// SPDX-License-Identifier: GPL-3.0-or-later
// Structural tags of the scene language, each described once.
#include "msml/compile/grammar.hpp"

#include <algorithm>
#include <array>

#include "msml/study/study.hpp"

namespace msml {
namespace {

void add(Registry& registry, Description description) {
  registry.add(std::make_shared<const Description>(std::move(description)));
}

/// A tag that only holds other tags; its category is its own name.
Description holder(const std::string& tag, const std::string& doc, std::vector<ChildRule> rules) {
  Description description(tag, tag, doc);
  for (ChildRule& rule : rules) description.allow(std::move(rule));
  return description;
}

void add_top(Registry& registry) {
  add(registry,
      holder("msml", "A scene: what is given, what it is made of, how it is computed.",
             {{"variables", 0, 1}, {"scene", 0, 1}, {"workflow", 0, 1}, {"environment", 0, 1}, {"studies", 0, 1}}));
  add(registry, holder("variables", "Names for values, used as ${name}.", {{"var"}}));
  VariableKeys keys;
  add(registry, describe_variable(keys));
  add(registry, holder("scene", "The bodies that are simulated.", {{"object"}}));
  add(registry, holder("workflow", "The tasks: each an operator with its inputs and settings.", {{"operator"}}));
  add_study_tags(registry);
}

void add_sets(Registry& registry) {
  add(registry, holder("sets", "Named groups of nodes, elements and faces.",
                       {{"nodes", 0, 1}, {"elements", 0, 1}, {"surfaces", 0, 1}}));
  for (const char* tag : {"nodes", "elements", "surfaces"})
    add(registry, holder(tag, "Named groups of one kind.", {{"indexgroup"}}));
  Description group("indexgroup", "indexgroup", "A named group.");
  group.parameter<std::string>("id", {.optional = true, .doc = "label of the group"});
  group.input<IndexSet>("indices", "what the group holds");
  add(registry, std::move(group));
}

void add_object(Registry& registry) {
  Description object =
      holder("object", "A body: mesh, material, constraints and what is wanted of it.",
             {{"meshes", 1, 1}, {"sets", 0, 1}, {"materials", 1, 1}, {"constraints", 0, 1}, {"outputs", 0, 1}});
  object.parameter<std::string>("id", {.optional = true, .doc = "label of the body"});
  add(registry, std::move(object));
  Description mesh("mesh", "meshes", "The mesh of the body.");
  mesh.allow({"mesh", 1, 1});
  add(registry, std::move(mesh));
  Description material("material", "materials", "What the body is made of, region by region.");
  material.allow({"region", 1});
  add(registry, std::move(material));
  Description region("region", "region", "A part of the body with one law and one density.");
  region.parameter<std::string>("id", {.optional = true, .doc = "label of the region"});
  region.input<IndexSet>("indices", {.indexes = Indexed::elements,
                                     .doc = "the elements; or nodes: then the elements with all corners among them"});
  region.allow({"material", 1, 1});
  region.allow({"mass", 0, 1});
  region.allow({"prony", 0, 1});
  add(registry, std::move(region));
  add(registry, holder("constraints", "What holds and what loads the body.", {{"constraint-group"}}));
  Description constraint("constraint", "constraint-group", "Constraints and loads that act together.");
  constraint.parameter<std::string>("name", {.optional = true, .doc = "label"});
  constraint.parameter<std::string>("forStep",
                                    {.optional = true, .doc = "step in which it acts; absent: in every step"});
  constraint.allow({"constraint"});
  add(registry, std::move(constraint));
  Description output("output", "outputs", "What is wanted of the simulation.");
  output.allow({"output"});
  add(registry, std::move(output));
}

void add_environment(Registry& registry) {
  EnvironmentKeys keys;
  add(registry, describe_environment(keys));
  add(registry, holder("simulation", "The steps, run one after another.", {{"step", 1}}));
}

}  // namespace

Description describe_environment(EnvironmentKeys& keys) {
  Description environment =
      holder("environment", "How the simulation is carried out.", {{"solver", 0, 1}, {"simulation", 0, 1}});
  keys.units = environment.parameter<std::string>(
      "units", {.optional = true, .doc = "label of the consistent units, such as 'mm N s MPa'; goes to the report"});
  return environment;
}

Description describe_variable(VariableKeys& keys) {
  Description var("var", "var", "A named value.");
  keys.name = var.parameter<std::string>("name", {.doc = "the name, used as ${name}"});
  keys.value = var.parameter<std::string>("value", {.doc = "a literal of the type of the attribute it is used in"});
  keys.logical =
      var.parameter<std::string>("logical", {.optional = true, .doc = "the meaning, a hint: Mesh, NodeSet, …"});
  keys.physical = var.parameter<std::string>("physical", {.optional = true, .doc = "the carrier, a hint: file.vtk, …"});
  keys.role = var.parameter<std::string>("role", {.optional = true,
                                                  .choices = {"input", "output", "param", "fix"},
                                                  .doc = "marks the scene's interface, see msml exec --set"});
  var.note(
      "Any tag of the scene may carry when=\"${name} = value\" (or !=, with | between several values): it is there "
      "only "
      "where that holds. So one scene has several elements, laws or operators to choose from.");
  return var;
}

void add_grammar(Registry& registry) {
  add_top(registry);
  add_sets(registry);
  add_object(registry);
  add_environment(registry);
}

bool is_legacy_attribute(const std::string& tag, const std::string& attribute) {
  constexpr std::array<const char*, 3> anywhere{"name", "id", "time"};
  if (std::find(anywhere.begin(), anywhere.end(), attribute) != anywhere.end()) return true;
  if (attribute.starts_with("xsi:") || attribute == "forStep") return true;
  if (tag == "var") return attribute == "type" || attribute == "format";
  return tag == "solver" && attribute.starts_with("hf3_");
}

}  // namespace msml
