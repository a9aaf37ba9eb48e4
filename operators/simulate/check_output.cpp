// SPDX-License-Identifier: GPL-3.0-or-later
// What may be asked of a simulation.
#include "operators/simulate/check_output.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "operators/simulate/fields.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

bool one_of(const std::string& field, const std::vector<const char*>& names) {
  return std::ranges::any_of(names, [&](const char* name) { return field == name; });
}

bool given(const Record& record, const char* attribute) {
  const int slot = record.description->find(attribute);
  return slot >= 0 && record.given[static_cast<std::size_t>(slot)];
}

/// Why the fields are none of the body's, and which it has.
std::string reason(const Words& wrong, const Surroundings& around) {
  const std::string verb = wrong.size() == 1 ? "is" : "are";
  if (around.scalar == true)
    return verb +
           " of displacements, but the unknown is a number (diffusionMaterial): there are value, reaction, region, "
           "energyDensity, stress (the flux) and strain (the gradient of value)";
  if (around.kind == CellKind::vertex)
    return verb + " of elements, which particles do not have: there are displacement, velocity, acceleration, reaction";
  return verb + " of scalar problems (diffusionMaterial): a solid has displacement";
}

/// False where it is told.
bool check_fields(const Record& output, const char* attribute, const Words& fields, const Surroundings& around,
                  const fe::Tell& tell) {
  Words wrong;
  std::ranges::copy_if(fields, std::back_inserter(wrong), [&](const auto& f) { return !has_meaning(f, around); });
  if (!wrong.empty())
    tell(fault_of(output, fmt::format("{}: {} {}", attribute, fmt::join(wrong, ", "), reason(wrong, around))));
  return wrong.empty();
}

void check_probe(const Record& output, const Surroundings& around, const fe::Tell& tell) {
  const std::string field = text_of(output, "field");
  if (field.empty()) return;
  if (around.scalar == true && field == "displacement")
    tell(fault_of(output,
                  "field: displacement is 0 where the unknown is a number (diffusionMaterial): take field=\"value\""));
  const bool sound = check_fields(output, "field", {field}, around, tell);
  if (around.kind == CellKind::vertex && (given(output, "point") || given(output, "along")))
    tell(fault_of(output, "particles have no inside: take indices instead of a point"));
  if (sound && given(output, "indices") && around.kind && !facts_of(field, around.mixed).nodal)
    tell(
        fault_of(output, fmt::format("field {} is given at elements; a probe at nodes takes {}, one at a point both",
                                     field, field == "J" || field == "region" ? "fields of nodes" : field + "_nodal")));
}

void check_section(const Record& output, const Surroundings& around, const fe::Tell& tell) {
  if (around.kind == CellKind::vertex) return tell(fault_of(output, "particles have no sections"));
  if (around.scalar == true) return tell(fault_of(output, "a scalar problem has no forces"));
  const auto* normal =
      std::get_if<std::vector<double>>(&output.values[static_cast<std::size_t>(output.description->find("normal"))]);
  if (!around.kind || normal == nullptr || normal->size() != 3) return;
  const int dimension = msml::dimension(*around.kind);
  const Vec3 n((*normal)[0], (*normal)[1], (*normal)[2]);
  if (std::any_of(normal->begin() + dimension, normal->end(), [](double part) { return part != 0; }))
    tell(fault_of(output, fmt::format("the normal {} leaves the {} of the body", place(n),
                                      dimension == 1 ? "line (along x)" : "plane (of x and y)")));
}

}  // namespace

bool has_meaning(const std::string& field, const Surroundings& around) {
  const std::string tail = "_nodal";
  const std::string base = field.ends_with(tail) ? field.substr(0, field.size() - tail.size()) : field;
  if (around.scalar == true)
    return one_of(base, {"displacement", "value", "reaction", "region", "energyDensity", "stress", "strain"});
  if (around.kind == CellKind::vertex)
    return one_of(base, {"displacement", "velocity", "acceleration", "reaction", "region"});
  return around.scalar != false || base != "value";
}

void check_output(const Record& output, const Surroundings& around, const fe::Tell& tell) {
  const std::string& tag = output.tag();
  if (tag == "result" && given(output, "fields"))
    if (const auto* fields =
            std::get_if<Words>(&output.values[static_cast<std::size_t>(output.description->find("fields"))]))
      check_fields(output, "fields", *fields, around, tell);
  if (tag == "probe") check_probe(output, around, tell);
  if (tag == "section") check_section(output, around, tell);
  if (tag == "volume" && around.kind == CellKind::vertex) tell(fault_of(output, "particles have no volume"));
}

}  // namespace msml::simulation
