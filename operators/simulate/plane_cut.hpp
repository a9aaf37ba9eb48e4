// SPDX-License-Identifier: GPL-3.0-or-later
// Elements cut by a plane in the reference configuration.
#pragma once
#include <array>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::simulation {

/// A plane in the reference configuration.
struct CuttingPlane {
  Vec3 point, normal;  ///< normal of length 1
  double tolerance;    ///< distances below it are 0
  /// Positive on the side of the normal.
  double distance(const Vec3& x) const;
};

/// One number per corner of an element, with sum 1; 0 for those it does not have.
using Barycentric = std::array<double, 4>;
/// A simplex inside an element, by as many corners as the element has.
using Part = std::array<Barycentric, 4>;

/// Where all of an element lies. What is on the plane counts to the side of the normal.
enum class PlaneSide { below, above, both };
/// Exact for straight elements; a curved one that comes close may count as `both`.
PlaneSide side_of(const Mesh& mesh, int element, const CuttingPlane& plane);

/// One, two or three places: a point of a line, a segment in a triangle, a triangle in a tetrahedron.
using Facet = std::vector<Barycentric>;

/// An element as the plane cuts it: the section, and what lies on the side of the normal. Exact for straight elements;
/// curved ones are cut in parts whose edges leave their chords by a hundredth of these, or after four halvings.
struct ElementCut {
  std::vector<Facet> section;
  std::vector<Part> above, missing;  ///< the side of the normal is `above` without `missing`, parts of these
};
ElementCut cut_element(const Mesh& mesh, int element, const CuttingPlane& plane);

/// The reference position of a place in an element.
Vec3 position(const Mesh& mesh, int element, const Barycentric& at);

}  // namespace msml::simulation
