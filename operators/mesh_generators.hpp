// SPDX-License-Identifier: GPL-3.0-or-later
// Structured meshes of simple bodies, for tests and examples.
#pragma once
#include <array>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// A box with edges along the axes.
struct Box {
  Vec3 origin = Vec3::Zero();  ///< corner with the smallest coordinates
  Vec3 size = Vec3::Ones();    ///< > 0
  std::array<int, 3> divisions{4, 4, 4};
};

/// A cylinder or tube around a line parallel to z.
struct Cylinder {
  Vec3 origin = Vec3::Zero();    ///< centre of the base
  double radius = 1, inner = 0;  ///< 0 <= inner < radius; 0 = full
  double height = 1;
  int around = 4;        ///< divisions of 45 degrees
  int across = 4;        ///< divisions from the inner surface (or a square core) to the outer one
  int along = 4;         ///< divisions of the height
  bool quarter = false;  ///< only x, y >= those of the origin; the cuts lie exactly in the planes
};

/// A ball or hollow sphere.
struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 1, inner = 0;  ///< 0 <= inner < radius; 0 = full
  int around = 4;                ///< divisions of 45 degrees of a great circle
  int across = 4;                ///< divisions from the inner surface (or a cubic core) to the outer one
  bool octant = false;           ///< only x, y, z >= those of the centre; the cuts lie exactly in the planes
};

/// tri3 cells in the plane of the origin, counter-clockwise, two for each cell of a grid; then line2 cells on the four
/// edges, the body on their left.
struct Rectangle {
  Vec3 origin = Vec3::Zero();  ///< corner with the smallest coordinates
  double width = 1, height = 1;
  std::array<int, 2> divisions{4, 4};
};
Mesh generate(const Rectangle& rectangle);

/// line2 cells along x; then vertex cells at both ends.
struct Segment {
  Vec3 origin = Vec3::Zero();
  double length = 1;
  int divisions = 4;
};
Mesh generate(const Segment& segment);

/// tet4 meshes with positive volumes. Every hexahedral cell of a grid is cut into six tetrahedra (five where that is
/// what its neighbours imply): each face along the diagonal through its point with the smallest id, after J. Dompierre
/// et al., How to subdivide pyramids, prisms and hexahedra into tetrahedra, 1999. Points on curved boundaries lie
/// exactly on them.
Mesh generate(const Box& box);
Mesh generate(const Cylinder& cylinder);
Mesh generate(const Sphere& sphere);

/// The same as tet10 with mid nodes of curved boundaries on them: for hollow bodies every edge bends with the radius,
/// for full ones the edges of the outer surface do.
Mesh generate_quadratic(const Cylinder& cylinder);
Mesh generate_quadratic(const Sphere& sphere);

}  // namespace msml::operators
