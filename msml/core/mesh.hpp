// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry that flows on the edges: fields, meshes, surfaces and sets of indices.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace msml {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// #points x 3, row after row in memory (x y z x y z …).
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Named values, `components` numbers for each point or cell; values.size() = count * components.
/// Symmetric tensors have 6 components: xx yy zz xy yz xz (VTK's order).
struct Field {
  std::string name;
  int components = 1;
  std::vector<double> values;
};

/// The cells a mesh can hold. Node numbering is VTK's:
///   line3: 0-2-1;  tri6: 3 on 01, 4 on 12, 5 on 20;
///   tet10: 4 on 01, 5 on 12, 6 on 20, 7 on 03, 8 on 13, 9 on 23.
enum class CellKind : std::uint8_t { vertex, line2, line3, tri3, tri6, tet4, tet10 };

int node_count(CellKind kind);    ///< nodes of one cell: 1, 2, 3, 3, 6, 4, 10
int dimension(CellKind kind);     ///< 0, 1, 2 or 3
int corner_count(CellKind kind);  ///< dimension + 1
const char* name(CellKind kind);  ///< "tet4"
int vtk_type(CellKind kind);      ///< VTK's cell type number: 1, 3, 21, 5, 22, 10, 24

/// Points and cells of mixed kinds. Cell ids run over all kinds in file order, as VTK's do.
struct Mesh {
  Points points;                    ///< #points x 3, reference positions
  std::vector<CellKind> kinds;      ///< #cells
  std::vector<int> offsets{0};      ///< #cells + 1; nodes of cell c are nodes[offsets[c] .. offsets[c+1])
  std::vector<int> nodes;           ///< point ids, cell after cell
  std::vector<int> regions;         ///< #cells, or empty: all in region 0. Written as cell array "region"
  std::vector<Field> point_fields;  ///< each with #points values
  std::vector<Field> cell_fields;   ///< each with #cells values

  int point_count() const { return static_cast<int>(points.rows()); }
  int cell_count() const { return static_cast<int>(kinds.size()); }
  /// Pointer to the first of the cell's node ids; node_count(kinds[cell]) of them.
  const int* cell(int c) const { return nodes.data() + offsets[static_cast<std::size_t>(c)]; }
  /// Appends a cell and returns its id. `ids` holds node_count(kind) point ids.
  int add_cell(CellKind kind, const int* ids, int region = 0);
  int count(CellKind kind) const;
  bool has(CellKind kind) const { return count(kind) > 0; }
  int region(int c) const { return regions.empty() ? 0 : regions[static_cast<std::size_t>(c)]; }
  /// "1,204 points, 5,310 tet4, 820 tri3"
  std::string summary() const;
  /// Throws Error unless sizes agree, every point is finite and every node id is in range.
  void check() const;
};

/// A triangle surface.
struct Surface {
  Points points;                              ///< #points x 3
  std::vector<std::array<int, 3>> triangles;  ///< point ids, counter-clockwise seen from outside
  std::vector<Field> point_fields, cell_fields;
  int point_count() const { return static_cast<int>(points.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
  std::string summary() const;  ///< "1,204 points, 2,400 triangles"
  void check() const;           ///< as Mesh::check
};

/// The same surface as a mesh of tri3 cells (loses nothing).
Mesh to_mesh(const Surface& surface);

/// What the ids of an IndexSet count. `faces` are ids of triangle cells of the mesh.
enum class Indexed : std::uint8_t { nodes, elements, faces };
const char* name(Indexed kind);  ///< "nodes", "elements", "faces"

/// Ids of nodes, elements or faces of one mesh, 0-based, sorted ascending and distinct where made by an operator.
struct IndexSet {
  Indexed kind = Indexed::nodes;
  std::vector<int> ids;
  std::shared_ptr<const Mesh> mesh;  ///< the mesh that the ids index; null for a literal list
};

/// "1,234,567"
std::string with_commas(long long value);

/// The four faces of a tetrahedron, corners counter-clockwise seen from outside; for tet10 the mid nodes of the edges
/// 01, 12, 20 of that face follow (tri6 order).
extern const std::array<std::array<int, 6>, 4> tet_faces;

/// The sides of a cell: faces of a tetrahedron (as in tet_faces), edges 01, 12, 20 of a triangle (counter-clockwise,
/// the mid node last), end points 0 and 1 of a line.
int side_count(CellKind kind);                             ///< dimension + 1; 0 for a vertex
CellKind side_kind(CellKind kind);                         ///< tri3, tri6, line2, line3 or vertex
std::span<const int> side_nodes(CellKind kind, int side);  ///< local node numbers, node_count(side_kind(kind)) of them

}  // namespace msml
