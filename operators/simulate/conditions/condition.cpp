// SPDX-License-Identifier: GPL-3.0-or-later
// What the descriptions of constraints and loads share.
#include "operators/simulate/conditions/condition.hpp"

#include <algorithm>

#include "operators/simulate/records.hpp"

namespace msml::simulation {

namespace {

std::string no_axis(const Value& value) {
  return std::get<Words>(value).empty() ? "it names no axis; allowed are x, y and z" : "";
}

}  // namespace

std::vector<ConditionFactory> conditions() {
  return {fixed_constraint(),
          displacement_constraint(),
          force_constraint(),
          surface_pressure(),
          surface_pressure_on_mesh(),
          surface_traction(),
          body_force(),
          symmetry_plane(),
          roller(),
          initial_velocity(),
          initial_displacement(),
          spring(),
          spring_to_point(),
          spring_mesh_to_fixed(),
          fixed_value(),
          flux(),
          source(),
          supporting_mesh()};
}

CommonKeys add_common(Description& description, const std::string& doc, Indexed indexes) {
  CommonKeys keys;
  keys.indices = description.input<IndexSet>("indices", {.indexes = indexes, .doc = doc});
  keys.for_step = description.parameter<std::string>(
      "forStep", {.optional = true, .doc = "name of the step it acts in; absent: as the constraint around it says"});
  return keys;
}

Key<Words> add_components(Description& description) {
  return description.parameter<Words>("components",
                                      {.optional = true,
                                       .choices = {"x", "y", "z"},
                                       .check = no_axis,
                                       .doc = "the axes that are held, such as \"x z\"; absent: all three"});
}

void read_components(const Record& record, Key<Words> components, fe::Prescribed& prescribed) {
  if (!record.has(components)) return;
  std::fill(std::begin(prescribed.components), std::end(prescribed.components), false);
  for (const std::string& axis : record[components]) prescribed.components[axis.front() - 'x'] = true;
}

namespace {

std::string table_problem(const Value& value) {
  const auto& list = std::get<std::vector<double>>(value);
  for (std::size_t i = 2; i + 1 < list.size(); i += 2)
    if (!(list[i] > list[i - 2]))
      return fmt::format("times must ascend, but {:g} follows {:g}; it lists time, factor, time, factor, …", list[i],
                         list[i - 2]);
  return {};
}

std::string signless_table_problem(const Value& value) {
  const auto& list = std::get<std::vector<double>>(value);
  for (std::size_t i = 1; i < list.size(); i += 2)
    if (list[i] < 0) return fmt::format("the factor {:g} is not >= 0", list[i]);
  return table_problem(value);
}

bool constant(const Formulas& formulas) {
  return std::all_of(formulas.begin(), formulas.end(), [](const Formula& each) { return each.constant(); });
}

bool steady(const std::vector<Function>& parts) {
  return std::none_of(parts.begin(), parts.end(), [](const Function& part) { return part.of_time(); });
}

std::vector<double> numbers(const Formulas& formulas) {
  std::vector<double> list;
  for (const Formula& each : formulas) list.push_back(each.number);
  return list;
}

const std::string& name_of(const Record& record, Key<Formulas> key) {
  return record.description->slots()[static_cast<std::size_t>(key.slot)].name;
}

}  // namespace

Key<std::vector<double>> add_table(Description& description, const std::string& of, bool signless) {
  return description.parameter<std::vector<double>>(
      "table",
      {.optional = true,
       .multiple_of = 2,
       .check = signless ? signless_table_problem : table_problem,
       .doc = "a factor in time on " + of +
              ": \"t0 v0 t1 v1 …\", linear between the times, constant before the first and after the last; nothing "
              "ramps then"});
}

fe::TimeFunction read_table(const Record& record, Key<std::vector<double>> table) {
  if (!record.has(table)) return {};
  std::vector<double> times;
  for (std::size_t i = 0; i < record[table].size(); i += 2) times.push_back(record[table][i]);
  const auto value = [list = record[table]](double t) {
    if (t <= list.front()) return list[1];
    for (std::size_t i = 2; i + 1 < list.size(); i += 2)
      if (t < list[i]) {
        const double share = (t - list[i - 2]) / (list[i] - list[i - 2]);
        return list[i - 1] + share * (list[i + 1] - list[i - 1]);
      }
    return list.back();
  };
  return {value, times};
}

std::string label(const Record& record) { return record.id.empty() ? record.tag() : record.id; }

fe::VectorFunction vector_of(const std::vector<Function>& parts) {
  return [parts](const Vec3& X, double t) { return Vec3(parts[0](X, t), parts[1](X, t), parts[2](X, t)); };
}

NodeValues per_node(const Record& record, Key<Formulas> key, const NodeSelection& selection, const Mesh& mesh) {
  const Formulas& formulas = record[key];
  const std::string& attribute = name_of(record, key);
  check_per_node(record, attribute, formulas, !selection.positions.empty(), selection.listed);
  if (constant(formulas) && formulas.size() == 3)
    return {{Vec3(formulas[0].number, formulas[1].number, formulas[2].number)}, {}};
  if (formulas.size() == 3) {
    const std::vector<Function> parts = functions(record, key);
    const fe::VectorFunction function = vector_of(parts);
    if (!steady(parts)) return {{}, function};
    NodeValues values;
    for (const int node : selection.nodes) values.values.push_back(function(mesh.points.row(node).transpose(), 0));
    return values;
  }
  NodeValues values;
  for (const int position : selection.positions) {
    const Formula* at = formulas.data() + 3 * static_cast<std::size_t>(position);
    values.values.emplace_back(at[0].number, at[1].number, at[2].number);
  }
  return values;
}

fe::FaceLoad face_load(const Record& record, Key<Formulas> key, const FaceSelection& selection, bool follower) {
  const Formulas& formulas = record[key];
  check_per_face(record, name_of(record, key), formulas, selection.listed, static_cast<int>(selection.faces.size()));
  const bool expressions = !constant(formulas);
  fe::FaceLoad load{.name = label(record), .faces = selection.faces};
  const std::vector<Function> parts = functions(record, key);
  load.steady = steady(parts);
  if (formulas.size() == 3) {
    if (expressions)
      load.traction_function = vector_of(parts);
    else
      load.tractions = {Vec3(formulas[0].number, formulas[1].number, formulas[2].number)};
    return load;
  }
  load.follower = follower;
  if (expressions)
    load.pressure_function = parts.front();
  else
    load.pressures = numbers(formulas);
  return load;
}

bool follows(const Record& record, Key<bool> follower, const Formulas& pressure, const Body& body) {
  if (!record.has(follower)) return !body.small_strain;
  return record[follower] && pressure.size() != 3;
}

}  // namespace msml::simulation
