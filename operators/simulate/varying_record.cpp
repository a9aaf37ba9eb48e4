// SPDX-License-Identifier: GPL-3.0-or-later
// Works out attributes that are expressions or come from cell fields.
#include "operators/simulate/varying_record.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "operators/simulate/records.hpp"
#include "solver/materials/fibres.hpp"

namespace msml::simulation {
namespace {

const Field& field_of(const Record& record, const std::string& attribute, const std::string& name, const Mesh& mesh,
                      int components) {
  std::string known;
  for (const Field& field : mesh.cell_fields) {
    if (field.name == name && field.components == components) return field;
    if (field.name == name)
      refuse(record, fmt::format("{} is taken from the cell field '{}', which has {} instead of {}", attribute, name,
                                 counted(field.components, "component"), components));
    known += (known.empty() ? "" : ", ") + field.name;
  }
  refuse(record, fmt::format("{} = '{}' is no cell field of the mesh{}", attribute, name,
                             known.empty() ? ", which has none" : "; it has " + known));
}

/// An attribute, or an entry of one that is a list, and the name of the cell field that it comes from.
struct Named {
  std::size_t slot;
  int entry, count;  ///< the numbers from `entry` on
  std::string field;
};

/// Which numbers `attribute` means: "youngModulus", "mu", "mu[2]".
Named numbers_of(const Record& record, const std::string& attribute) {
  const std::string name = attribute.substr(0, attribute.find('['));
  const int found = record.description->find(name);
  const auto slot = static_cast<std::size_t>(found);
  const Type type = found < 0 ? Type::nothing : record.description->slots()[slot].type;
  if (type != Type::formula && type != Type::formulas)
    refuse(record, fmt::format("fields: '{}' is no attribute that takes a number", name));
  const auto* list = std::get_if<Formulas>(&record.values[slot]);
  const int length = list != nullptr ? static_cast<int>(list->size()) : 0;
  if (type == Type::formulas && length == 0)
    refuse(record, fmt::format("fields: '{}' is left out: give the list, with typical values", name));
  if (name == attribute) return {slot, 0, std::max(length, 1), {}};
  int entry = 0;
  const char *first = attribute.data() + name.size() + 1, *last = attribute.data() + attribute.size() - 1;
  const auto [end, error] = std::from_chars(first, std::max(first, last), entry);
  if (error != std::errc() || end != last || *last != ']' || entry < 1 || entry > length)
    refuse(record, fmt::format("fields: '{}' is no number of {}, {}", attribute, name,
                               length == 0 ? std::string("which is one number: leave out the brackets")
                                           : fmt::format("which has those from {0}[1] to {0}[{1}]", name, length)));
  return {slot, entry - 1, 1, {}};
}

bool overlap(const Named& a, const Named& b) {
  return a.slot == b.slot && a.entry < b.entry + b.count && b.entry < a.entry + a.count;
}

/// The numbers and the field that a part of the attribute `fields` names: "mu[2]=stiffness".
Named named_by(const Record& record, const std::string& part) {
  const std::size_t equals = part.find('=');
  if (equals == std::string::npos || equals + 1 == part.size())
    refuse(record, fmt::format("fields: '{}' is no pair attribute=field", part));
  Named found = numbers_of(record, part.substr(0, equals));
  found.field = part.substr(equals + 1);
  return found;
}

/// The attribute `fields`: "youngModulus=E mu[2]=stiffness".
std::vector<Named> named_numbers(const Record& record, const fe::Tell& tell = fe::raise) {
  std::vector<Named> named;
  for (const std::string& part : list_parts(text_of(record, "fields"))) try {
      const Named found = named_by(record, part);
      if (std::ranges::any_of(named, [&](const Named& other) { return overlap(found, other); }))
        refuse(record, fmt::format("fields names {} twice", part.substr(0, part.find('='))));
      named.push_back(found);
    } catch (const Error& error) {
      tell(error);
    }
  return named;
}

/// Three expressions, at least one of them of the place or of time; empty for anything else, such as a field's name.
Formulas direction_formulas(const std::string& text) {
  Formulas parts;
  bool varies = false;
  for (const std::string& part : expression_parts(text)) {
    const FormulaFacts facts = examine(part);
    if (!facts.problem.empty()) return {};
    varies = varies || facts.of_position || facts.of_time;
    parts.push_back(facts.of_position || facts.of_time ? Formula(part) : Formula(facts.value));
  }
  return varies && parts.size() == 3 ? parts : Formulas{};
}

/// The expressions of an attribute; empty where it is something else.
Formulas formulas_of(const Slot& slot, const Value& value) {
  if (const auto* one = std::get_if<Formula>(&value)) return {*one};
  if (const auto* list = std::get_if<Formulas>(&value)) return *list;
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && slot.unit == "direction" ? direction_formulas(*text) : Formulas{};
}

/// A direction that can only be meant as numbers or expressions has three, without faults.
void check_direction(const Record& record, const Slot& slot, const std::string& text, const fe::Tell& tell) {
  const std::vector<std::string> parts = expression_parts(text);
  const auto problem = [](const std::string& part) { return examine(part).problem; };
  const bool expressions = std::ranges::all_of(parts, [&](const std::string& part) { return problem(part).empty(); });
  const bool list = text.find_first_of(",(){}") != std::string::npos;
  const bool number = !parts.empty() && parts.front().find_first_not_of("+-.0123456789eE") == std::string::npos &&
                      parts.front().find_first_of("0123456789") != std::string::npos;
  if (!list && !number && (!expressions || parts.size() == 1)) return;  // the name of a field
  for (const std::string& part : parts)
    if (!problem(part).empty())
      return tell(fault_of(record, fmt::format("{} = '{}': '{}': {}", slot.name, text, part, problem(part))));
  for (const std::string& part : parts)
    if (const std::string never = never_allowed(part, {}); !never.empty())
      tell(fault_of(record, fmt::format("{}: '{}' {}", slot.name, part, never)));
  if (parts.size() != 3)
    tell(fault_of(record, fmt::format("{} = '{}' has {}; a direction has 3, or is the name of a cell field of the mesh",
                                      slot.name, text, counted(static_cast<long long>(parts.size()), "number"))));
}

std::string direction_text(double x, double y, double z) { return fmt::format("{} {} {}", x, y, z); }

}  // namespace

void VaryingRecord::check(const Record& record, const fe::Tell& tell) {
  named_numbers(record, tell);
  const std::vector<Slot>& slots = record.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s)
    if (const auto* text = std::get_if<std::string>(&record.values[s]); text != nullptr && slots[s].unit == "direction")
      check_direction(record, slots[s], *text, tell);
  expressions_of(record, tell);
}

std::vector<VaryingRecord::Expressions> VaryingRecord::expressions_of(const Record& record, const fe::Tell& tell) {
  std::vector<Expressions> found;
  const std::vector<Slot>& slots = record.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    Expressions all{s, {}};
    bool varies = false;
    for (const Formula& formula : formulas_of(slots[s], record.values[s])) {
      const Function& f = all.parts.emplace_back(formula, slots[s].name, slots[s].range, record.where);
      if (f.of_time())
        tell(fault_of(record,
                      fmt::format("{} = '{}' depends on t; here X, Y and Z may stand", slots[s].name, formula.text)));
      varies = varies || !f.constant();
    }
    if (varies) found.push_back(std::move(all));
  }
  return found;
}

VaryingRecord::VaryingRecord(const Record& record, const Body& body, const std::vector<int>& elements)
    : record_(record), mesh_(body.mesh), expressions_(expressions_of(record)) {
  find_fields();
  check_fields(elements);
}

void VaryingRecord::find_fields() {
  const std::vector<Slot>& slots = record_.description->slots();
  for (std::size_t s = 0; s < slots.size(); ++s) {
    const auto* text = std::get_if<std::string>(&record_.values[s]);
    if (slots[s].unit == "direction" && text != nullptr && fe::direction_numbers(*text).empty() &&
        direction_formulas(*text).empty())
      fields_.push_back({s, -1, &field_of(record_, slots[s].name, *text, *mesh_, 3)});
  }
  for (const auto& [slot, entry, count, field] : named_numbers(record_))
    fields_.push_back({slot, entry, &field_of(record_, slots[slot].name, field, *mesh_, count)});
}

void VaryingRecord::check_fields(const std::vector<int>& elements) const {
  for (const auto& [slot, entry, field] : fields_) {
    const Slot& described = record_.description->slots()[slot];
    for (const int e : elements) {
      const double* v = field->values.data() + static_cast<std::size_t>(e * field->components);
      const auto at = [&] { return fmt::format("in element {} at {}", e, place(centroid(*mesh_, e))); };
      if (entry < 0) {
        const double length = std::hypot(v[0], v[1], v[2]);
        if (!(length > 0) || !std::isfinite(length))
          refuse(record_, fmt::format("{}: the field '{}' holds ({:g}, {:g}, {:g}) {}, which is no direction",
                                      described.name, field->name, v[0], v[1], v[2], at()));
        continue;
      }
      for (int k = 0; k < field->components; ++k)
        if (!described.range.contains(v[k]))
          refuse(record_, fmt::format("{}: the field '{}' holds {:g} {}, which is not {}", described.name, field->name,
                                      v[k], at(), described.range.str()));
    }
  }
}

void VaryingRecord::put(const Source& source, int element, Record& record) const {
  const double* v = source.field->values.data() + static_cast<std::size_t>(element * source.field->components);
  Value& value = record.values[source.slot];
  if (source.entry < 0)
    value = direction_text(v[0], v[1], v[2]);
  else if (auto* list = std::get_if<Formulas>(&value))
    for (int k = 0; k < source.field->components; ++k)
      (*list)[static_cast<std::size_t>(source.entry + k)] = Formula(v[k]);
  else
    value = Formula(v[0]);
}

bool VaryingRecord::lists() const {
  return std::any_of(fields_.begin(), fields_.end(), [&](const Source& source) {
    return std::holds_alternative<Formulas>(record_.values[source.slot]);
  });
}

Record VaryingRecord::at(int element, const Vec3& X) const {
  Record record = record_;
  for (const auto& [slot, parts] : expressions_) {
    Value& value = record.values[slot];
    if (std::holds_alternative<Formula>(value)) {
      value = Formula(parts[0](X, 0));
    } else if (auto* list = std::get_if<Formulas>(&value)) {
      for (std::size_t i = 0; i < parts.size(); ++i) (*list)[i] = Formula(parts[i](X, 0));
    } else {
      value = direction_text(parts[0](X, 0), parts[1](X, 0), parts[2](X, 0));
    }
  }
  for (const Source& source : fields_) put(source, element, record);
  return record;
}

}  // namespace msml::simulation
