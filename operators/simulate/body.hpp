// SPDX-License-Identifier: GPL-3.0-or-later
// The elements that an object is made of, inside a mesh that may hold other cells too.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"
#include "solver/model.hpp"

namespace msml::simulation {

struct Body {
  std::shared_ptr<const Mesh> mesh;
  CellKind kind = CellKind::tet4;  ///< of the elements
  std::vector<int> elements;       ///< cell ids of that kind, ascending
  std::vector<bool> solid;         ///< #points: belongs to one of the elements; other points carry no unknowns
  bool small_strain = false;       ///< every region has a law of small strains
  bool scalar = false;             ///< the unknown is no displacement: the laws are of diffusion
};

/// The body of all cells of one kind in the mesh.
Body make_body(std::shared_ptr<const Mesh> mesh, CellKind kind);

/// "(0, 0, 0) to (1, 1, 2)": the corners of the box around the elements (around all points where there are none).
std::string bounds(const Body& body);

/// Length of the diagonal of the box around all points.
double diagonal(const Mesh& mesh);

/// Mean of a cell's corners.
Vec3 centroid(const Mesh& mesh, int cell);

/// The same points and cells, whether in the same memory or not.
bool same_mesh(const Mesh& a, const Mesh& b);

/// The corners of a side of an element: 3 of a face, 2 of an edge, 1 of an end point; -1 for those it does not have.
using SideCorners = std::array<int, 3>;

/// Finds the sides of a body's elements (faces of tetrahedra, edges of triangles, ends of lines) by their corners.
class FaceTable {
 public:
  explicit FaceTable(const Body& body);
  /// The boundary side with these corners in any order; element -1 if there is none.
  fe::Face boundary(SideCorners corners) const;
  /// True if the corners are those of a side between two elements.
  bool inside(SideCorners corners) const;
  /// All boundary faces, by element, then local number.
  const std::vector<fe::Face>& boundary_faces() const { return boundary_; }

 private:
  struct Entry {
    SideCorners corners;  ///< ascending
    fe::Face face;
    bool shared = false;
  };
  const Entry* find(SideCorners corners) const;
  std::vector<Entry> entries_;  ///< ascending by corners, distinct
  std::vector<fe::Face> boundary_;
};

/// Point ids of a side: its corners, then its mid nodes.
std::vector<int> face_nodes(const Mesh& mesh, const fe::Face& face);

/// Finds the solid nodes of a body at a place, within a millionth of the mesh's diagonal.
class PlaceTable {
 public:
  explicit PlaceTable(const Body& body);
  /// Ids of all solid nodes there, ascending.
  std::vector<int> at(const Vec3& x) const;

 private:
  using Box = std::array<long long, 3>;
  Box box_of(const Vec3& x) const;
  const Mesh& mesh_;
  double size_ = 1;
  Vec3 origin_ = Vec3::Zero();
  std::map<Box, std::vector<int>> boxes_;
};

}  // namespace msml::simulation
