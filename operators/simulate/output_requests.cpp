// SPDX-License-Identifier: GPL-3.0-or-later
// The tags of what is written of a simulation.
#include <algorithm>

#include "operators/simulate/fields.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"

namespace msml::simulation {
namespace {

const Words usual_fields{"displacement", "velocity",      "stress", "vonMises", "stress_nodal", "vonMises_nodal",
                         "strain",       "energyDensity", "J",      "reaction", "region"};

struct Keys {
  Key<std::string> id;
  Key<Words> fields;
  Key<Integer> every, timestep;
  Key<bool> asterisk;
};

Keys add_common(Factory<OutputRequest>& tag) {
  Keys keys;
  keys.id = tag.parameter<std::string>("id", {.doc = "start of the file names, and what ${id} refers to"});
  keys.every = tag.parameter<Integer>(
      "every", {.range = closed(1, 1e9), .optional = true, .doc = "states 0, every, 2 every, … and the last"});
  tag.produces(Type::series);
  tag.note("Files: ID_0000.vtu, ID_0001.vtu, …, ID.pvd (all states in time, for ParaView), ID.json (the check).");
  tag.note("Points are the deformed positions; the field displacement is x - X.");
  return keys;
}

std::string file_stem(const Record& record, Key<std::string> key) {
  const std::string& id = record[key];
  if (id.empty() || id == "." || id == ".." || id.find('/') != std::string::npos)
    refuse(record, fmt::format("id = '{}' cannot start a file name", id));
  return id;
}

/// Each once, displacement first.
Words distinct(const Words& wanted) {
  Words fields{"displacement"};
  for (const std::string& word : wanted)
    if (std::find(fields.begin(), fields.end(), word) == fields.end()) fields.push_back(word);
  return fields;
}

Factory<OutputRequest> displacement() {
  Factory<OutputRequest> tag("displacement", "output", "The deformed mesh at the times of the simulation.");
  Keys keys = add_common(tag);
  keys.timestep =
      tag.parameter<Integer>("timestep", {.range = closed(0, 1e9), .fallback = 1, .doc = "as every; 0 counts as 1"});
  keys.asterisk =
      tag.parameter<bool>("useAsterisk", {.fallback = false, .doc = "${id} stands for the pattern ID_*.vtu"});
  tag.note("MSML's timestep=\"k\" wrote every k+1 steps; here it is every k steps.");
  tag.build([=](const Record& record) {
    OutputRequest request{
        .id = file_stem(record, keys.id), .fields = {"displacement", "region"}, .where = record.where};
    request.every =
        static_cast<int>(record.has(keys.every) ? record[keys.every] : std::max<Integer>(1, record[keys.timestep]));
    return request;
  });
  return tag;
}

Factory<OutputRequest> result() {
  Factory<OutputRequest> tag("result", "output", "Fields on the deformed mesh at the times of the simulation.");
  Keys keys = add_common(tag);
  keys.fields = tag.parameter<Words>(
      "fields", {.fallback = usual_fields, .choices = field_names(), .doc = "what is written besides displacement"});
  tag.note("Tensors have 6 components xx yy zz xy yz xz, or 9: xx xy xz yx yy yz zx zy zz.");
  for (const FieldFacts& facts : all_fields())
    tag.note(fmt::format("{} ({}, at {}): {}", facts.name, counted(facts.components, "number"),
                         facts.nodal ? "nodes" : "elements", facts.doc));
  tag.build([=](const Record& record) {
    OutputRequest request{
        .id = file_stem(record, keys.id), .fields = distinct(record[keys.fields]), .where = record.where};
    if (record.has(keys.every)) request.every = static_cast<int>(record[keys.every]);
    return request;
  });
  return tag;
}

Key<Integer> add_every(Factory<OutputRequest>& tag) {
  return tag.parameter<Integer>(
      "every",
      {.range = closed(1, 1e9), .fallback = 1, .doc = "states 0, every, 2 every, … and the last; load steps count"});
}

struct ProbeKeys {
  Key<std::string> id, field;
  Key<std::vector<double>> point, along;
  Key<Integer> count, every;
};

ProbeKeys describe_probe(Factory<OutputRequest>& tag) {
  ProbeKeys keys;
  keys.id = tag.parameter<std::string>("id", {.doc = "name of the file, and what ${id} refers to"});
  keys.point = tag.parameter<std::vector<double>>(
      "point", {.unit = "length",
                .optional = true,
                .counts = {3},
                .doc = "the place in the reference configuration, inside the body: the field is interpolated there"});
  keys.along = tag.parameter<std::vector<double>>(
      "along", {.unit = "length",
                .optional = true,
                .counts = {6},
                .doc = "start and end of a line inside the body, x y z each: a line of the file for each place"});
  keys.count = tag.parameter<Integer>(
      "count", {.range = closed(2, 100000), .fallback = 11, .doc = "of along: places, evenly spaced, both ends too"});
  tag.input<IndexSet>("indices", {.optional = true, .doc = "nodes instead of a point: a column for each"});
  keys.field = tag.parameter<std::string>(
      "field", {.fallback = "displacement", .choices = field_names(), .doc = "what is written"});
  keys.every = add_every(tag);
  return keys;
}

Vec3 three_of(const std::vector<double>& numbers, std::size_t first = 0) {
  return Vec3(numbers[first], numbers[first + 1], numbers[first + 2]);
}

void place_probe(const Record& record, const ProbeKeys& keys, OutputRequest& request) {
  const bool nodes = record.given[static_cast<std::size_t>(record.description->find("indices"))];
  if (nodes + record.is_given(keys.point) + record.is_given(keys.along) != 1)
    refuse(record, "needs one of point, along and indices");
  if (record.has(keys.point)) request.point = three_of(record[keys.point]);
  if (!record.has(keys.along)) return;
  request.point = three_of(record[keys.along]);
  request.end = three_of(record[keys.along], 3);
  request.count = static_cast<int>(record[keys.count]);
  if (request.end == *request.point) refuse(record, "along starts and ends at one place; for one place there is point");
}

Factory<OutputRequest> probe() {
  Factory<OutputRequest> tag("probe", "output",
                             "A field at a place, along a line or at nodes over time, as a CSV file.");
  const ProbeKeys keys = describe_probe(tag);
  tag.produces(Type::file);
  tag.note("File: ID.csv, a line of names, then a line per state: the time and the components of the field.");
  tag.note(
      "Along a line there are as many lines per state as places, with the distance from its start beside the time.");
  tag.note("At a point, a field given at elements has the value of the element that holds the point.");
  tag.build([=](const Record& record) {
    OutputRequest request{.id = file_stem(record, keys.id),
                          .every = static_cast<int>(record[keys.every]),
                          .fields = {record[keys.field]},
                          .where = record.where,
                          .kind = OutputKind::probe,
                          .record = &record};
    place_probe(record, keys, request);
    return request;
  });
  return tag;
}

Factory<OutputRequest> energies() {
  Factory<OutputRequest> tag("energies", "output", "Energies, work and momentum over time, as a CSV file.");
  const auto id = tag.parameter<std::string>("id", {.doc = "name of the file, and what ${id} refers to"});
  const auto every = add_every(tag);
  tag.produces(Type::file);
  tag.note(
      "File: ID.csv with the columns time, elastic and kinetic energy, work of loads and moved supports, energy "
      "dissipated by damping and by viscoelastic regions (the work of their stresses that is not stored: by Maxwell's "
      "springs and dampers, exact for laws linear in their strain), momentum and angular momentum about the origin, "
      "and in statics the share of the step's loads, 0 in the first state, which has none (quasiStatic: of the step's "
      "time). Elastic, kinetic and dissipated energy sum to that of the first state "
      "and "
      "the work, but for what falls with the time step: with its square for Newmark, generalizedAlpha and "
      "centralDifference, in proportion to it for the others, and where loads or supports jump.");
  tag.build([=](const Record& record) {
    return OutputRequest{.id = file_stem(record, id),
                         .every = static_cast<int>(record[every]),
                         .fields = {},
                         .where = record.where,
                         .kind = OutputKind::energies};
  });
  return tag;
}

Factory<OutputRequest> section() {
  Factory<OutputRequest> tag("section", "output", "Area, force and moment on a plane through the body, as a CSV file.");
  const auto id = tag.parameter<std::string>("id", {.doc = "name of the file, and what ${id} refers to"});
  const auto point = tag.parameter<std::vector<double>>(
      "point", {.unit = "length", .counts = {3}, .doc = "a place of the plane, in the reference configuration"});
  const auto normal = tag.parameter<std::vector<double>>(
      "normal", {.counts = {3}, .doc = "of the plane in the reference configuration, of any length but 0"});
  const auto every = add_every(tag);
  tag.produces(Type::file);
  tag.note(
      "File: ID.csv with the columns time, area (of the deformed section), the force that the body on the side of the "
      "normal exerts on the other side (in tension along the normal), and its moment about the deformed section's "
      "centroid.");
  tag.note(
      "The force is the work of the stress on the elements that the plane cuts, as their corners on the side of the "
      "normal move by one unit, and the moment as they turn, less the part of gravity, body forces, tractions, "
      "pressures, inertia and "
      "mass-proportional damping that acts between the plane and these corners: both balance what acts beyond the "
      "plane, wherever it lies in the elements, on coarse meshes too (of quadratic elements at finite strains the "
      "moment up to their size). Curved elements are cut along their shapes. A "
      "supportingMesh carries its part.");
  tag.build([=](const Record& record) {
    OutputRequest request{.id = file_stem(record, id),
                          .every = static_cast<int>(record[every]),
                          .fields = {},
                          .where = record.where,
                          .kind = OutputKind::section,
                          .point = three_of(record[point]),
                          .normal = three_of(record[normal]),
                          .record = &record};
    if (!(request.normal.norm() > 0)) refuse(record, "normal has no direction: at least one number is not 0");
    return request;
  });
  return tag;
}

Factory<OutputRequest> volume() {
  Factory<OutputRequest> tag("volume", "output", "Volumes of the regions over time, as a CSV file.");
  const auto id = tag.parameter<std::string>("id", {.doc = "name of the file, and what ${id} refers to"});
  const auto every = add_every(tag);
  tag.produces(Type::file);
  tag.note("File: ID.csv with the columns time, the deformed volume of each region, and that of the body.");
  tag.build([=](const Record& record) {
    return OutputRequest{.id = file_stem(record, id),
                         .every = static_cast<int>(record[every]),
                         .fields = {},
                         .where = record.where,
                         .kind = OutputKind::volume};
  });
  return tag;
}

}  // namespace

bool OutputRequest::wants(const std::string& field) const {
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

std::vector<Factory<OutputRequest>> outputs() {
  return {displacement(), result(), probe(), energies(), section(), volume()};
}

}  // namespace msml::simulation
