// SPDX-License-Identifier: GPL-3.0-or-later
// The one conversion between this program's geometry and VTK's. Include the VTK headers of the classes you use
// yourself.
#pragma once
#include <string>

#include "msml/core/image.hpp"
#include "msml/core/mesh.hpp"

template <class T>
class vtkSmartPointer;
class vtkImageData;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace msml::operators {

/// Cells keep their order and numbering, region ids become the active cell scalars "region" (int), fields become arrays
/// of doubles, points are doubles. Throws Error where a field holds NaN or infinity.
vtkSmartPointer<vtkUnstructuredGrid> to_vtk(const Mesh& mesh);
vtkSmartPointer<vtkPolyData> to_vtk(const Surface& surface);
/// Origin, spacing and direction are kept; voxels become the point scalars "values".
vtkSmartPointer<vtkImageData> to_vtk(const Image& image);

/// The cells in their order. All numeric arrays are kept as fields of doubles, except that the first of the cell arrays
/// "region", "Materials", "medit:ref", "gmsh:physical" that holds whole numbers becomes the region ids.
/// Throws Error with count and kind of cells other than those of CellKind, and where an id, point or field is not
/// valid.
Mesh to_mesh(vtkUnstructuredGrid& grid);
/// The same for polygonal data: vertices, lines and triangles in VTK's order of cells.
Mesh to_mesh(vtkPolyData& data);

/// Polygons of more than three corners and strips are cut into triangles (vtkTriangleFilter, which passes cell fields
/// on); then triangle ids differ from the cell ids of the file. Throws Error where there are vertices or lines.
Surface to_surface(vtkPolyData& data);

/// A surface of the tri3 cells of a mesh that has no others; region ids become a cell field "region". Throws Error that
/// counts the other cells and names ExtractSurfaceMesh.
Surface to_surface(const Mesh& mesh);

/// Voxel types without a counterpart widen to the next that holds all values of the image. `array` is the name of the
/// point array to take, "" = the active scalars or else the first array. Throws Error where there is none.
Image to_image(vtkImageData& data, const std::string& array = "");

}  // namespace msml::operators
