// SPDX-License-Identifier: GPL-3.0-or-later
// Elements cut by a plane in the reference configuration.
#pragma once
#include <Eigen/LU>
#include <array>
#include <cmath>
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

/// From the coordinates of the unit simplex to those of an element's, onto a part of it.
template <int dimension>
class PartMap {
 public:
  explicit PartMap(const Part& part) : part_(part) {
    for (std::size_t i = 0; i < dimension; ++i)
      for (std::size_t d = 0; d < dimension; ++d)
        edges_(static_cast<int>(i), static_cast<int>(d)) = part[i + 1][d + 1] - part[0][d + 1];
  }
  /// Of the part beside the whole element.
  double size() const { return std::abs(edges_.determinant()); }
  std::array<double, dimension> at(const std::array<double, dimension>& xi) const {
    std::array<double, dimension> place;
    for (std::size_t d = 0; d < dimension; ++d) {
      place[d] = part_[0][d + 1];
      for (std::size_t i = 0; i < dimension; ++i) place[d] += xi[i] * edges_(static_cast<int>(i), static_cast<int>(d));
    }
    return place;
  }

 private:
  const Part& part_;
  Eigen::Matrix<double, dimension, dimension> edges_;
};

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
