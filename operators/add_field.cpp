// SPDX-License-Identifier: GPL-3.0-or-later
// AddFieldToMesh: a field from formulas, such as fibre directions or a stiffness that changes from place to place.
#include <fmt/format.h>

#include <algorithm>

#include "msml/core/formula.hpp"
#include "msml/core/operator.hpp"
#include "operators/early_checks.hpp"

namespace msml::operators {
namespace {

Vec3 centre(const Mesh& mesh, int cell) {
  const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(cell)]);
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < corners; ++a) sum += mesh.points.row(mesh.cell(cell)[a]).transpose();
  return sum / corners;
}

/// The formulas at points or at the centres of cells, one after the other.
Field evaluated(const Mesh& mesh, const std::string& name, const std::vector<Function>& formulas, bool at_cells) {
  Field field{name, static_cast<int>(formulas.size()), {}};
  const int count = at_cells ? mesh.cell_count() : mesh.point_count();
  field.values.reserve(static_cast<std::size_t>(count) * formulas.size());
  for (int i = 0; i < count; ++i) {
    const Vec3 X = at_cells ? centre(mesh, i) : Vec3(mesh.points.row(i).transpose());
    for (const Function& formula : formulas) field.values.push_back(formula(X, 0));
  }
  return field;
}

void refuse_time(const std::vector<Function>& formulas) {
  if (std::any_of(formulas.begin(), formulas.end(), [](const Function& each) { return each.of_time(); }))
    throw Error("values depends on t, but a field of a mesh does not change in time: use X, Y and Z alone");
}

}  // namespace

Operator add_field() {
  Operator op("AddFieldToMesh", "Give a mesh a field from formulas of the position.");
  op.note(
      "Materials read fields of cells by name: fiber=\"NAME\" takes three values as the direction of the fibres, "
      "fields=\"youngModulus=NAME\" one as a parameter.");
  const auto given = op.input<Mesh>("mesh", "any mesh");
  const auto name = op.parameter<std::string>("name", {.doc = "of the field; one that is there is replaced"});
  const auto values = op.parameter<Formulas>(
      "values", {.doc = "one formula in X, Y and Z for each component; three make a vector, such as a direction"});
  const auto at = op.parameter<std::string>(
      "at", {.fallback = "cells", .choices = {"cells", "points"}, .doc = "centres of the cells, or points"});
  const auto result = op.output<Mesh>("result", "the mesh with the field");
  op.target("meshFilename", result, "file to write the mesh to");
  const auto check = [=](const Record& r) {
    if (r.has(values)) refuse_time(functions(r, values));
  };
  run_checked(op, check, [=](Context& c) {
    const std::vector<Function> formulas = functions(c.args(), values);
    Mesh mesh = c.get(given);
    const bool at_cells = c.get(at) == "cells";
    std::vector<Field>& fields = at_cells ? mesh.cell_fields : mesh.point_fields;
    std::erase_if(fields, [&](const Field& field) { return field.name == c.get(name); });
    fields.push_back(evaluated(mesh, c.get(name), formulas, at_cells));
    c.set(result, std::move(mesh));
  });
  return op;
}

}  // namespace msml::operators
