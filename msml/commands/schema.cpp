// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions -> XSD.
#include "msml/commands/schema.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "msml/compile/grammar.hpp"

namespace msml {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string documentation(const std::string& text, const std::string& indent) {
  return fmt::format("{0}<xs:annotation><xs:documentation>{1}</xs:documentation></xs:annotation>\n", indent,
                     escaped(text));
}

std::string type_name(const Description& description) { return description.category() + "." + description.tag(); }

/// The restriction of a number to its range, or "" where it is not bounded.
std::string range_facets(const Range& range) {
  std::string text;
  if (std::isfinite(range.low))
    text += fmt::format("<xs:min{}clusive value=\"{}\"/>", range.low_open ? "Ex" : "In", range.low);
  if (std::isfinite(range.high))
    text += fmt::format("<xs:max{}clusive value=\"{}\"/>", range.high_open ? "Ex" : "In", range.high);
  return text;
}

/// An anonymous type: the restriction of `base`, or a reference.
std::string union_with_reference(const std::string& base, const std::string& facets) {
  return fmt::format(
      "        <xs:simpleType><xs:union memberTypes=\"reference\"><xs:simpleType><xs:restriction "
      "base=\"{}\">{}</xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n",
      base, facets);
}

std::string attribute(const Slot& slot, bool verbatim) {
  std::string head = fmt::format("      <xs:attribute name=\"{}\"", slot.name);
  if (slot.required) head += " use=\"required\"";
  const std::string doc = documentation(slot.doc, "        ");
  const std::string tail = "      </xs:attribute>\n";
  if (slot.role == Role::parameter && !slot.choices.empty() && slot.type == Type::text && !verbatim) {
    std::string facets;
    for (const std::string& choice : slot.choices)
      facets += fmt::format("<xs:enumeration value=\"{}\"/>", escaped(choice));
    return head + ">\n" + doc + union_with_reference("xs:string", facets) + tail;
  }
  if (slot.role == Role::parameter && slot.type == Type::number)
    return head + ">\n" + doc + union_with_reference("xs:double", range_facets(slot.range)) + tail;
  if (slot.role == Role::parameter && slot.type == Type::integer)
    return head + ">\n" + doc + union_with_reference("xs:integer", range_facets(slot.range)) + tail;
  const char* type = slot.type == Type::boolean ? "boolean" : "xs:string";
  return head + fmt::format(" type=\"{}\">\n", type) + doc + tail;
}

/// Attributes that old scenes carry without meaning, and the condition that any tag may have.
std::string legacy_attributes(const Description& description) {
  std::string text;
  std::set<std::string> names{"id", "name", "time", "forStep", when_attribute};
  if (description.tag() == "var") names.insert({"type", "format"});
  for (const std::string& name : names)
    if (description.find(name) < 0) text += fmt::format("      <xs:attribute name=\"{}\" type=\"xs:string\"/>\n", name);
  const bool open = description.tag() == "solver" || !description.unavailable().empty();
  const char* any = open ? "##any" : "##other";
  return text + fmt::format("      <xs:anyAttribute namespace=\"{}\" processContents=\"skip\"/>\n", any);
}

std::string complex_type(const Registry& registry, const Description& description) {
  std::string text = fmt::format("  <xs:complexType name=\"{}\">\n", type_name(description)) +
                     documentation(description.doc(), "    ");
  std::string inside;
  std::vector<std::string> categories;
  for (const ChildRule& rule : description.children()) categories.push_back(rule.category);
  if (description.category() == "operator") categories.push_back("operator");
  for (const std::string& category : categories)
    for (const Description* child : registry.of_category(category))
      if (category != "operator" || child->children().empty())
        inside += fmt::format("      <xs:element name=\"{}\" type=\"{}\"/>\n", child->tag(), type_name(*child));
  if (!inside.empty())
    text += "    <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n" + inside + "    </xs:choice>\n";
  for (const Slot& slot : description.slots())
    if (slot.role != Role::output) text += attribute(slot, description.tag() == "var");
  return text + legacy_attributes(description) + "  </xs:complexType>\n";
}

constexpr const char* head = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- Made by `msml schema` from the descriptions of operators and tags. Do not edit. -->
<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema" xmlns="http://sfb125.de/msml"
           targetNamespace="http://sfb125.de/msml" elementFormDefault="unqualified">
  <xs:element name="msml" type="msml.msml"/>
  <xs:simpleType name="reference">
    <xs:restriction base="xs:string"><xs:pattern value="\s*[$]\{[^}]*\}\s*"/></xs:restriction>
  </xs:simpleType>
  <xs:simpleType name="boolean">
    <xs:union memberTypes="reference">
      <xs:simpleType><xs:restriction base="xs:string">
        <xs:pattern value="\s*([Tt][Rr][Uu][Ee]|[Ff][Aa][Ll][Ss][Ee]|1|0|[Yy][Ee][Ss]|[Nn][Oo]|[Oo][Nn]|[Oo][Ff][Ff])\s*"/>
      </xs:restriction></xs:simpleType>
    </xs:union>
  </xs:simpleType>
)";

}  // namespace

std::string schema_text(const Registry& registry) {
  std::string text = head;
  for (const auto& description : registry.descriptions()) text += complex_type(registry, *description);
  for (const auto& op : registry.operators())
    if (op->children().empty()) text += complex_type(registry, *op);
  return text + "</xs:schema>\n";
}

}  // namespace msml
