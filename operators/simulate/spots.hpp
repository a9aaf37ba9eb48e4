// SPDX-License-Identifier: GPL-3.0-or-later
// Places inside a body.
#pragma once
#include <span>
#include <vector>

#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// A place in an element: weights of its nodes, with sum 1.
struct Spot {
  int element = -1;
  std::vector<double> weights;
  double outside = 0;  ///< largest negative barycentric coordinate, as a positive number; 0 inside
};

/// Finds the element that holds a place of the reference configuration.
class SpotFinder {
 public:
  /// `body` has elements other than vertices and must outlive the finder.
  explicit SpotFinder(const Body& body);
  /// The element that holds the place; outside the body the one with the least Spot::outside, its shapes continued.
  Spot find(const Vec3& x) const;

 private:
  using Box = std::array<int, 3>;
  Box box_of(const Vec3& x) const;
  std::size_t index(const Box& box) const;
  const Body& body_;
  Vec3 low_ = Vec3::Zero(), size_ = Vec3::Ones();
  int count_ = 1;                        ///< boxes along each axis
  std::vector<std::vector<int>> boxes_;  ///< elements that may hold places of each
};

/// Values of an element's shape functions at barycentric coordinates (one per corner).
std::vector<double> shape_weights(CellKind kind, std::span<const double> barycentric);

/// Distance of a place outside a body from it: from its boundary faces, or from the nodes of lines and triangles.
double distance_to(const Body& body, const Vec3& x);

}  // namespace msml::simulation
