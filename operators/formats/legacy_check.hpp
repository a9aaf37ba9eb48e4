// SPDX-License-Identifier: GPL-3.0-or-later
// A walk over a legacy VTK file that keeps VTK's reader from stepping outside of its arrays.
#pragma once
#include <string_view>

namespace msml::operators {

/// Throws Error where points, cells or byte values of the file are cut off, or where the lists of a section CELLS,
/// VERTICES, LINES, POLYGONS or TRIANGLE_STRIPS (files before version 5) do not add up to the size it announces. What
/// follows CELL_TYPES or the first attribute other than bytes is left to VTK's reader.
void check_legacy_cells(std::string_view file);

}  // namespace msml::operators
