// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of a material that are expressions or come from cell fields.
#include "operators/simulate/region_materials.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "msml/core/formula.hpp"
#include "operators/simulate/records.hpp"
#include "solver/materials/fibres.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

using LawPtr = std::shared_ptr<const fe::Law>;

/// An attribute and the cell field that it comes from.
struct Source {
  std::size_t slot;
  const Field* field;
};

/// An attribute that is an expression.
struct Expression {
  std::size_t slot;
  Function function;
};

const Field& field_of(const Record& material, const std::string& attribute, const std::string& name, const Mesh& mesh,
                      int components) {
  std::string known;
  for (const Field& field : mesh.cell_fields) {
    if (field.name == name && field.components == components) return field;
    if (field.name == name)
      refuse(material, fmt::format("{} is taken from the cell field '{}', which has {} instead of {}", attribute, name,
                                   counted(field.components, "component"), components));
    known += (known.empty() ? "" : ", ") + field.name;
  }
  refuse(material, fmt::format("{} = '{}' is no cell field of the mesh{}", attribute, name,
                               known.empty() ? ", which has none" : "; it has " + known));
}

/// Directions that are not three numbers name a field.
void add_directions(const Record& material, const Mesh& mesh, std::vector<Source>& sources) {
  const std::vector<Slot>& slots = material.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    const auto* text = std::get_if<std::string>(&material.values[s]);
    if (slots[s].unit == "direction" && text != nullptr && fe::direction_numbers(*text).empty())
      sources.push_back({s, &field_of(material, slots[s].name, *text, mesh, 3)});
  }
}

/// An attribute and the name of the cell field that it comes from.
struct Named {
  std::size_t slot;
  std::string field;
};

/// The attribute `fields`: "youngModulus=E mu=stiffness".
std::vector<Named> named_numbers(const Record& material) {
  std::vector<Named> named;
  std::string list = text_of(material, "fields");
  std::replace(list.begin(), list.end(), ',', ' ');
  const std::vector<Slot>& slots = material.description->slots();
  for (std::size_t i = 0; (i = list.find_first_not_of(" \t\r\n", i)) != std::string::npos;) {
    const std::size_t end = std::min(list.find_first_of(" \t\r\n", i), list.size());
    const std::string part = list.substr(i, end - i);
    i = end;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals + 1 == part.size())
      refuse(material, fmt::format("fields: '{}' is no pair attribute=field", part));
    const std::string attribute = part.substr(0, equals);
    const int slot = material.description->find(attribute);
    if (slot < 0 || slots[static_cast<std::size_t>(slot)].type != Type::formula)
      refuse(material, fmt::format("fields: '{}' is no attribute that takes a number", attribute));
    named.push_back({static_cast<std::size_t>(slot), part.substr(equals + 1)});
  }
  return named;
}

void add_numbers(const Record& material, const Mesh& mesh, std::vector<Source>& sources) {
  for (const auto& [slot, field] : named_numbers(material))
    sources.push_back({slot, &field_of(material, material.description->slots()[slot].name, field, mesh, 1)});
}

/// A direction that is three expressions, at least one of them of the place.
bool of_expressions(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  int count = 0;
  bool varies = false;
  for (std::string word; words >> word; ++count) {
    const FormulaFacts facts = examine(word);
    if (!facts.problem.empty()) return false;
    varies = varies || facts.of_position || facts.of_time;
  }
  return count == 3 && varies;
}

/// The record with an element's own values.
Record record_of(Record material, const std::vector<Source>& sources, int element) {
  for (const auto& [slot, field] : sources) {
    const double* value = field->values.data() + static_cast<std::size_t>(element * field->components);
    if (field->components == 3)
      material.values[slot] = fmt::format("{} {} {}", value[0], value[1], value[2]);
    else
      material.values[slot] = Formula(value[0]);
  }
  return material;
}

/// Throws Error where an element's value is outside the range of its attribute, or no direction.
void check_values(const Record& material, const std::vector<Source>& sources, const Body& body,
                  const std::vector<int>& elements) {
  for (const auto& [slot, field] : sources) {
    const Slot& described = material.description->slots()[slot];
    for (const int e : elements) {
      const double* v = field->values.data() + static_cast<std::size_t>(e * field->components);
      const auto at = [&] { return fmt::format("in element {} at {}", e, place(centroid(*body.mesh, e))); };
      if (field->components == 3) {
        const double length = std::hypot(v[0], v[1], v[2]);
        if (!(length > 0) || !std::isfinite(length))
          refuse(material, fmt::format("{}: the field '{}' holds ({:g}, {:g}, {:g}) {}, which is no direction",
                                       described.name, field->name, v[0], v[1], v[2], at()));
      } else if (!described.range.contains(v[0])) {
        refuse(material, fmt::format("{}: the field '{}' holds {:g} {}, which is not {}", described.name, field->name,
                                     v[0], at(), described.range.str()));
      }
    }
  }
}

std::vector<Expression> expressions_of(const Record& material) {
  std::vector<Expression> found;
  const std::vector<Slot>& slots = material.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    const auto* formula = std::get_if<Formula>(&material.values[s]);
    if (formula == nullptr || formula->constant()) continue;
    Function f(*formula, slots[s].name, slots[s].range, material.where);
    if (f.of_time())
      refuse(material,
             fmt::format("{} = '{}' depends on t; a material may depend on X, Y and Z", slots[s].name, formula->text));
    found.push_back({s, std::move(f)});
  }
  return found;
}

/// The record with the values at a place.
Record record_at(Record material, const std::vector<Expression>& expressions, const Vec3& X) {
  for (const auto& [slot, function] : expressions) material.values[slot] = Formula(function(X, 0));
  return material;
}

/// Up to eight laws side by side; the last fills the lanes that are left.
LawPtr side_by_side(const Record& material, std::vector<LawPtr> laws) {
  laws.resize(fe::lanes, laws.back());
  LawPtr merged = laws.front()->merged(laws);
  if (!merged) refuse(material, "cannot differ between elements");
  return merged;
}

}  // namespace

void check_sources(const Record& material) {
  const std::vector<Slot>& slots = material.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    const auto* text = std::get_if<std::string>(&material.values[s]);
    if (slots[s].unit == "direction" && text != nullptr && of_expressions(*text))
      refuse(material, fmt::format("{} = '{}': a direction is three numbers, or the name of a cell field with three "
                                   "components where it varies; expressions are not taken",
                                   slots[s].name, *text));
  }
  named_numbers(material);
  expressions_of(material);
}

void set_material(const Record& material, const Body& body, fe::Region& region) {
  check_sources(material);
  std::vector<Source> sources;
  add_directions(material, *body.mesh, sources);
  add_numbers(material, *body.mesh, sources);
  const std::vector<Expression> expressions = expressions_of(material);
  if (region.elements.empty()) return;
  if (!sources.empty() && !expressions.empty())
    refuse(material, "takes some attributes from cell fields and others from expressions. Take all from one of them");
  const int first = region.elements.front();
  if (!expressions.empty()) {
    for (const int e : region.elements) record_at(material, expressions, centroid(*body.mesh, e));  // are all in range?
    region.law = make<LawPtr>(record_at(material, expressions, centroid(*body.mesh, first)));
    region.point_law = [material, expressions](std::span<const Vec3> places) {
      std::vector<LawPtr> laws;
      for (const Vec3& X : places) laws.push_back(make<LawPtr>(record_at(material, expressions, X)));
      return side_by_side(material, std::move(laws));
    };
    return;
  }
  check_values(material, sources, body, region.elements);
  region.law = make<LawPtr>(record_of(material, sources, first));
  if (sources.empty()) return;
  region.local_law = [material, sources, mesh = body.mesh](std::span<const int> elements) {
    std::vector<LawPtr> laws;
    for (const int e : elements) laws.push_back(make<LawPtr>(record_of(material, sources, e)));
    return side_by_side(material, std::move(laws));
  };
}

}  // namespace msml::simulation
