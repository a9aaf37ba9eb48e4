// SPDX-License-Identifier: GPL-3.0-or-later
// What the descriptions of constraints and loads share.
#include "operators/simulate/conditions/condition.hpp"

#include <algorithm>

#include "operators/simulate/records.hpp"

namespace msml::simulation {

std::vector<ConditionFactory> conditions() {
  return {fixed_constraint(), displacement_constraint(),  force_constraint(),
          surface_pressure(), surface_pressure_on_mesh(), surface_traction()};
}

CommonKeys add_common(Description& description, const std::string& doc, Indexed indexes) {
  CommonKeys keys;
  keys.indices = description.input<IndexSet>("indices", {.indexes = indexes, .doc = doc});
  keys.for_step = description.parameter<std::string>(
      "forStep", {.optional = true, .doc = "name of the step it acts in; absent: as the constraint around it says"});
  return keys;
}

Key<std::string> add_components(Description& description) {
  return description.parameter<std::string>(
      "components", {.optional = true, .doc = "the axes that are held, such as \"x z\"; absent: all three"});
}

void read_components(const Record& record, Key<std::string> components, fe::Prescribed& prescribed) {
  if (!record.has(components)) return;
  std::fill(std::begin(prescribed.components), std::end(prescribed.components), false);
  bool any = false;
  for (const char c : record[components]) {
    if (c == ' ' || c == ',' || c == '\t' || c == '\n') continue;
    if (c < 'x' || c > 'z')
      refuse(record, fmt::format("components = '{}' is not a list of x, y and z", record[components]));
    prescribed.components[c - 'x'] = any = true;
  }
  if (!any) refuse(record, "components names no axis; allowed are x, y and z");
}

std::string label(const Record& record) { return record.id.empty() ? record.tag() : record.id; }

std::vector<Vec3> per_node(const Record& record, const std::vector<double>& numbers, const NodeSelection& selection,
                           const std::string& attribute) {
  if (numbers.size() == 3) return {Vec3(numbers[0], numbers[1], numbers[2])};
  const bool listed = !selection.positions.empty();
  if (!listed)
    refuse(record, fmt::format("{} has {} numbers; with indices of faces or elements 3 are allowed, the same for all "
                               "nodes",
                               attribute, numbers.size()));
  if (numbers.size() != 3 * static_cast<std::size_t>(selection.listed))
    refuse(record, fmt::format("{} has {} numbers; allowed are 3, or 3 for each of the {} in indices ({})", attribute,
                               numbers.size(), counted(selection.listed, "node"), 3 * selection.listed));
  std::vector<Vec3> values;
  for (const int position : selection.positions) {
    const double* at = numbers.data() + 3 * static_cast<std::size_t>(position);
    values.emplace_back(at[0], at[1], at[2]);
  }
  return values;
}

fe::FaceLoad face_load(const Record& record, const std::vector<double>& numbers, const FaceSelection& selection,
                       const std::string& attribute, bool follower) {
  fe::FaceLoad load{.name = label(record), .faces = selection.faces};
  if (numbers.size() == 3) {
    load.tractions = {Vec3(numbers[0], numbers[1], numbers[2])};
    return load;
  }
  const bool one_each = selection.listed && numbers.size() == selection.faces.size();
  if (numbers.size() != 1 && !one_each)
    refuse(record, fmt::format("{} has {} numbers; allowed are 1, 3 (a traction vector){}", attribute, numbers.size(),
                               selection.listed ? fmt::format(", or one for each of the {} in indices",
                                                              counted(static_cast<int>(selection.faces.size()), "face"))
                                                : std::string(" where indices counts nodes")));
  load.pressures = numbers;
  load.follower = follower;
  return load;
}

bool follows(const Record& record, Key<bool> follower, const std::vector<double>& pressure, const Body& body) {
  if (!record.has(follower)) return !body.small_strain;
  if (record[follower] && pressure.size() == 3)
    refuse(record, "follower = true has no meaning for a traction vector (three numbers), which keeps its direction");
  return record[follower];
}

}  // namespace msml::simulation
