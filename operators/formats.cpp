// SPDX-License-Identifier: GPL-3.0-or-later
// The list of file formats that the program reads and writes.
#include "operators/formats/formats.hpp"

namespace msml::operators {

void add_formats(Registry& registry);

void add_formats(Registry& registry) {
  for (const auto& format : {legacy_vtk, vtk_xml_grid, vtk_xml_poly, vtk_xml_image, stl, off, obj, ply, medit, gmsh,
                             inrimage, nifti, meta_image, nrrd})
    registry.add(format());
}

}  // namespace msml::operators
