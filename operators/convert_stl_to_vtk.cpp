// SPDX-License-Identifier: GPL-3.0-or-later
// ConvertSTLToVTK: hands a surface on, so that it can be written in another format.
#include "msml/core/operator.hpp"

namespace msml::operators {

Operator convert_stl_to_vtk();

Operator convert_stl_to_vtk() {
  Operator op("ConvertSTLToVTK", "Reads a triangle surface, from STL or any other format, and writes it to another.");
  op.note(
      "Equal corners of STL triangles become one point. The name of the target decides the format, .vtk or any "
      "other that holds a Surface.");
  const auto stl = op.input<Surface>("STLMesh", "triangles");
  const auto vtk = op.output<Surface>("VTKMesh", "the same triangles");
  op.target("targetFilename", vtk, "file to write the surface to");
  op.run([=](Context& c) { c.set(vtk, c.share(stl)); });
  return op;
}

}  // namespace msml::operators
