// SPDX-License-Identifier: GPL-3.0-or-later
// ConvertVTKToVTU: hands a mesh on, so that it can be written in another format.
#include "msml/core/operator.hpp"

namespace msml::operators {

Operator convert_vtk_to_vtu();

Operator convert_vtk_to_vtu() {
  Operator op("ConvertVTKToVTU", "Reads a mesh, from a legacy VTK file or any other format, and writes it to another.");
  op.note(
      "MSML writes ASCII, as the name of its output says; here .vtu holds raw binary doubles, which lose nothing "
      "and load faster. Cells, their order, region ids and fields are kept.");
  const auto vtk = op.input<Mesh>("VTKMesh", "cells of any supported kind");
  const auto vtu = op.output<Mesh>("VTKMeshAscii", "the same mesh");
  op.target("targetFilename", vtu, "file to write the mesh to");
  op.run([=](Context& c) { c.set(vtu, c.share(vtk)); });
  return op;
}

}  // namespace msml::operators
