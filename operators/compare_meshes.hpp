// SPDX-License-Identifier: GPL-3.0-or-later
// Differences between the fields of two meshes, node by node or by interpolation.
#pragma once
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// How one field of A differs from the field of the same name of B. |d| is the Euclidean length over the components.
struct FieldDifference {
  std::string name;
  bool on_cells = false;  ///< a field of cells, else of points
  int components = 1;
  std::size_t count = 0;  ///< places compared
  double l2 = 0;          ///< sqrt(integral of |d|^2 over B's reference configuration): point fields linear between
                          ///< nodes (a tet10 as eight tet4), cell fields constant; over the cells of highest dimension
  double rms = 0;         ///< sqrt(mean of |d|^2 over the places), each counted once
  double max = 0;         ///< largest |d|
  double reference_max = 0;   ///< largest length of B's field, to relate the others to
  double reference_l2 = 0;    ///< as l2, of B's field itself
  int where_id = -1;          ///< node or cell of B with the largest |d|
  Vec3 where = Vec3::Zero();  ///< its place in B's reference configuration
};

struct Comparison {
  bool by_node = false;         ///< same cells, and nodes at the same reference places: compared without interpolation
  std::size_t outside = 0;      ///< nodes of B that lie outside A; they take the value at the nearest point of A
  double outside_distance = 0;  ///< the largest distance of these from A
  std::vector<FieldDifference> fields;            ///< point fields in the order of B, then cell fields
  std::vector<std::string> only_in_a, only_in_b;  ///< fields without a partner of equal components
  /// The largest FieldDifference::max, 0 without fields.
  double max() const;
};

/// Reference positions: the points, less the point field "displacement" of three components where there is one.
Points reference_points(const Mesh& mesh);

/// Compares all fields of A with those of B (the reference). Meshes match by node when their cells are equal and their
/// reference positions differ by no more than 1e-6 of B's diagonal; else A is interpolated at B's reference nodes, and
/// at the centres of B's cells for cell fields, with the shape functions of A's cells of highest dimension.
/// Region ids are compared as the cell field "region". Throws Error if A has no cells to interpolate in, or B no
/// points.
Comparison compare(const Mesh& a, const Mesh& b);

}  // namespace msml::operators
