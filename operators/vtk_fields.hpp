// SPDX-License-Identifier: GPL-3.0-or-later
// Fields to and from VTK's attribute arrays.
#pragma once
#include <vector>

#include "msml/core/mesh.hpp"

class vtkDataSetAttributes;

namespace msml::operators {

/// Throws Error where a value is NaN or infinite or the number of values does not fit `count`. `what` is "point" or
/// "cell", for the message.
void check_field(const Field& field, std::size_t count, const char* what);

/// Adds one array of doubles per field. Throws Error as check_field does.
void add_fields(const std::vector<Field>& fields, std::size_t count, const char* what, vtkDataSetAttributes& out);

/// All numeric arrays as fields; texts are left out. Throws Error as above.
std::vector<Field> fields_of(vtkDataSetAttributes& in, std::size_t count, const char* what);

/// Takes the region ids out of the cell fields: the first of "region", "Materials", "medit:ref", "gmsh:physical" that
/// has one component and holds whole numbers. Empty if there is none.
std::vector<int> take_regions(std::vector<Field>& cell_fields);

}  // namespace msml::operators
