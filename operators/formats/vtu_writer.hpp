// SPDX-License-Identifier: GPL-3.0-or-later
// Writes .vtu files straight from the arrays of a mesh.
#pragma once
#include <filesystem>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// A file as VTK's XML writer makes it (appended raw binary, not compressed), without copies of the arrays. Region ids
/// are the cell array "region"; of two fields with one name the later is written. Throws Error where the mesh is not in
/// order, a field holds a NaN or has the wrong size, or the file cannot be written.
void write_vtu(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace msml::operators
