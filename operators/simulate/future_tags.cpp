// SPDX-License-Identifier: GPL-3.0-or-later
// Tags that the language knows and the program does not carry out yet.
#include "operators/simulate/settings.hpp"

namespace msml::simulation {
namespace {

struct Attribute {
  const char* name;
  Type type;
  const char* doc;
};

void add(Description& tag, const Attribute& attribute) {
  switch (attribute.type) {
    case Type::number:
      tag.parameter(attribute.name, {.optional = true, .doc = attribute.doc});
      return;
    case Type::numbers:
      tag.parameter<std::vector<double>>(attribute.name, {.optional = true, .doc = attribute.doc});
      return;
    case Type::integer:
      tag.parameter<Integer>(attribute.name, {.optional = true, .doc = attribute.doc});
      return;
    case Type::boolean:
      tag.parameter<bool>(attribute.name, {.optional = true, .doc = attribute.doc});
      return;
    case Type::mesh:
      tag.input<Mesh>(attribute.name, attribute.doc, true);
      return;
    case Type::index_set:
      tag.input<IndexSet>(attribute.name, attribute.doc, true);
      return;
    default:
      tag.parameter<std::string>(attribute.name, {.optional = true, .doc = attribute.doc});
  }
}

Description future(const char* tag, const char* category, const char* doc, const char* instead,
                   const std::vector<Attribute>& attributes) {
  Description description(tag, category, doc);
  description.not_available_yet(instead);
  for (const Attribute& attribute : attributes) add(description, attribute);
  return description;
}

void add_msml_constraints(std::vector<Description>& tags) {
  tags.push_back(future("shapeMatchingConstraint", "constraint", "Pulls the surface onto a target surface by charges.",
                        "move the surface with displacementConstraint",
                        {{"referenceMesh", Type::mesh, "target surface"},
                         {"charge", Type::number, "strength"},
                         {"adaptCharge", Type::boolean, "adapt it"},
                         {"samplingDistance", Type::number, "length"},
                         {"adaptSamplingDistance", Type::boolean, "adapt it"},
                         {"adaptActiveTriangles", Type::boolean, "adapt them"},
                         {"forStep", Type::text, "step"}}));
  tags.push_back(future(
      "contactsurface", "constraint", "Contact geometry.", "bodies do not touch each other",
      {{"surface", Type::mesh, "the surface"}, {"exportFile", Type::text, "file"}, {"forStep", Type::text, "step"}}));
}

}  // namespace

std::vector<Description> future_tags() {
  std::vector<Description> tags;
  add_msml_constraints(tags);
  return tags;
}

}  // namespace msml::simulation
