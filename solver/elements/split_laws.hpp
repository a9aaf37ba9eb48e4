// SPDX-License-Identifier: GPL-3.0-or-later
// Laws taken apart for elements that treat the volume change apart.
#pragma once
#include <span>
#include <vector>

#include "solver/materials/law.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// The laws of eight elements as rest(F) + modulus/2 g(F)^2: one for all quadrature points, or one for each.
class BatchSplit {
 public:
  BatchSplit() = default;
  /// The laws of up to eight elements of a region, lane k for element k, at the reference positions `places[q]` of
  /// quadrature point q in each. Each has passed check_law.
  BatchSplit(const Region& region, std::span<const int> elements, std::span<const std::vector<Vec3>> places);

  const Lanes& modulus(std::size_t point) const { return of(point).modulus; }        ///< infinite if incompressible
  const Lanes& compliance(std::size_t point) const { return of(point).compliance; }  ///< 1 / modulus
  /// Energy and derivatives of rest and of g at the points, as Law::evaluate.
  void evaluate_rest(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const;
  void evaluate_constraint(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const;
  std::size_t bytes() const { return points_.size() * sizeof(Point); }  ///< of the list, not of the laws

 private:
  struct Point {
    std::shared_ptr<const Law> rest, constraint;
    Lanes modulus, compliance;
  };
  const Point& of(std::size_t point) const { return points_[points_.size() == 1 ? 0 : point]; }
  std::vector<Point> points_;
};

}  // namespace msml::fe
