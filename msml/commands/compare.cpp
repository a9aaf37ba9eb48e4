// SPDX-License-Identifier: GPL-3.0-or-later
// compare: differences of the fields of two meshes.
#include "operators/compare_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "msml/commands/commands.hpp"

namespace msml {
namespace {

using operators::Comparison;
using operators::FieldDifference;

double relative(const FieldDifference& field) {
  return field.reference_max > 0 ? field.max / field.reference_max : field.max;
}

bool wanted(const std::vector<std::string>& fields, const std::string& name) {
  return fields.empty() || std::find(fields.begin(), fields.end(), name) != fields.end();
}

/// Fields named on the command line that both files do not have.
void check_wanted(const Comparison& comparison, const CompareArguments& arguments) {
  std::vector<std::string> known;
  for (const FieldDifference& field : comparison.fields) known.push_back(field.name);
  for (const std::string& name : arguments.fields)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error("--field " + name + ": not a field of both files" + did_you_mean(name, known));
}

void print_head(const Comparison& comparison, const CompareArguments& arguments) {
  std::printf("%s against %s, %s\n", arguments.a.c_str(), arguments.b.c_str(),
              comparison.by_node ? "node by node" : "interpolated at the reference's nodes");
  if (comparison.outside > 0)
    std::printf("%zu nodes of the reference lie outside, at most %.6g away: they take the nearest value\n",
                comparison.outside, comparison.outside_distance);
  std::printf("%-24s %-6s %12s %12s %12s %12s  at\n", "field", "on", "L2", "RMS", "max", "max/ref");
}

void print_field(const FieldDifference& field) {
  std::printf("%-24s %-6s %12.5g %12.5g %12.5g %12.5g  %s %d (%.6g %.6g %.6g)\n", field.name.c_str(),
              field.on_cells ? "cells" : "points", field.l2, field.rms, field.max, relative(field),
              field.on_cells ? "cell" : "node", field.where_id, field.where[0], field.where[1], field.where[2]);
}

void print_unmatched(const std::vector<std::string>& names, const std::string& file) {
  for (const std::string& name : names) std::printf("%-24s only in %s\n", name.c_str(), file.c_str());
}

}  // namespace

int compare_command(const Registry& registry, const CompareArguments& arguments) {
  const auto read = [&](const std::string& file) { return std::get<MeshPtr>(registry.read(file, Type::mesh)); };
  const Comparison comparison = operators::compare(*read(arguments.a), *read(arguments.b));
  check_wanted(comparison, arguments);
  print_head(comparison, arguments);
  bool above = false;
  for (const FieldDifference& field : comparison.fields) {
    if (!wanted(arguments.fields, field.name)) continue;
    print_field(field);
    above |= arguments.has_tolerance && !(relative(field) <= arguments.tolerance);
  }
  print_unmatched(comparison.only_in_a, arguments.a);
  print_unmatched(comparison.only_in_b, arguments.b);
  if (comparison.fields.empty()) throw Error("the files have no field in common");
  if (above) std::printf("above the tolerance of %g\n", arguments.tolerance);
  return above ? 1 : 0;
}

}  // namespace msml
