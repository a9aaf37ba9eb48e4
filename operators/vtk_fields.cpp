// SPDX-License-Identifier: GPL-3.0-or-later
// Fields to and from VTK's attribute arrays, checked on the way.
#include "operators/vtk_fields.hpp"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

Field field_of(vtkDataArray& array, int index) {
  Field field;
  field.name = array.GetName() && *array.GetName() ? array.GetName() : fmt::format("array{}", index);
  field.components = array.GetNumberOfComponents();
  const vtkIdType tuples = array.GetNumberOfTuples();
  field.values.resize(static_cast<std::size_t>(tuples) * static_cast<std::size_t>(field.components));
  for (vtkIdType i = 0; i < tuples; ++i) array.GetTuple(i, field.values.data() + i * field.components);
  return field;
}

bool holds_region_ids(const Field& field) {
  constexpr double most = std::numeric_limits<int>::max();
  return field.components == 1 && std::all_of(field.values.begin(), field.values.end(),
                                              [](double v) { return v == std::floor(v) && std::abs(v) <= most; });
}

}  // namespace

void check_field(const Field& field, std::size_t count, const char* what) {
  if (field.components < 1 || field.values.size() != count * static_cast<std::size_t>(field.components))
    throw Error(fmt::format("{} field '{}' has {} values for {} {}s of {} components", what, field.name,
                            field.values.size(), count, what, field.components));
  const auto bad = std::find_if(field.values.begin(), field.values.end(), [](double v) { return !std::isfinite(v); });
  if (bad != field.values.end())
    throw Error(fmt::format("{} field '{}' is {} at {} {}; only finite numbers are allowed", what, field.name, *bad,
                            what, (bad - field.values.begin()) / field.components));
}

void add_fields(const std::vector<Field>& fields, std::size_t count, const char* what, vtkDataSetAttributes& out) {
  for (const Field& field : fields) {
    check_field(field, count, what);
    const vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(field.components);
    array->SetNumberOfTuples(static_cast<vtkIdType>(count));
    std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
    out.AddArray(array);
  }
}

std::vector<Field> fields_of(vtkDataSetAttributes& in, std::size_t count, const char* what) {
  std::vector<Field> fields;
  for (int i = 0; i < in.GetNumberOfArrays(); ++i) {
    vtkDataArray* const array = in.GetArray(i);
    if (array == nullptr) continue;
    fields.push_back(field_of(*array, i));
    check_field(fields.back(), count, what);
  }
  return fields;
}

std::vector<int> take_regions(std::vector<Field>& cell_fields) {
  for (const char* name : {"region", "Materials", "medit:ref", "gmsh:physical"}) {
    const auto found = std::find_if(cell_fields.begin(), cell_fields.end(),
                                    [&](const Field& f) { return f.name == name && holds_region_ids(f); });
    if (found == cell_fields.end()) continue;
    std::vector<int> regions(found->values.begin(), found->values.end());
    cell_fields.erase(found);
    return regions;
  }
  return {};
}

}  // namespace msml::operators
