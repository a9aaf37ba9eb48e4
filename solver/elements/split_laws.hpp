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
  /// The modulus with which an incompressible law is as good as one, for joined(): 1e7 shear moduli leave an error of
  /// 1e-7 in what the shape stores.
  double largest_modulus(std::size_t point) const { return 1e7 * of(point).rest->shear_modulus(); }
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

/// The whole response at a point from those of rest and of g: W = rest + p^2/(2 k), P = rest + p dg/dF, and with
/// `tangents` rest + p d2g/dF2 + k dg/dF x dg/dF, where k is at most `largest` (an infinite one would let nothing else
/// be seen).
Response joined(const Response& rest, const Response& volume, const Lanes& p, Lanes modulus, double largest,
                bool tangents);

}  // namespace msml::fe
