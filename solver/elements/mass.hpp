// SPDX-License-Identifier: GPL-3.0-or-later
// Element mass matrices.
#pragma once
#include <utility>
#include <vector>

#include "solver/elements/shapes.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// One number per pair of nodes, the same for x, y and z: int rho N_a N_b dV.
template <int nodes>
using ElementMass = Eigen::Matrix<double, nodes, nodes>;

/// Consistent mass. Exact where the density is constant: degree 2 for linear elements; for quadratic ones degree 4,
/// times up to 3 of a curved Jacobian. `density`(X) is per reference volume, times the thickness of a triangle or the
/// cross-section of a line.
template <int dimension, int nodes, class Density>
ElementMass<nodes> consistent_mass(const Points& points, const int* ids, const Density& density) {
  static const Rule<dimension> rule = rule_of_size<dimension>(Simplex<dimension, nodes>::quadratic ? 4 : 2);
  ElementMass<nodes> M = ElementMass<nodes>::Zero();
  for (const auto& q : rule) {
    const auto N = Simplex<dimension, nodes>::values(q.xi);
    const double w = density(place<dimension, nodes>(points, ids, q.xi)) * q.weight *
                     jacobian<dimension, nodes>(points, ids, q.xi).determinant();
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b) M(a, b) += w * N[a] * N[b];
  }
  return M;
}

/// The same for one density; the integral of a straight element is known.
template <int dimension, int nodes>
ElementMass<nodes> consistent_mass(const Points& points, const int* ids, double density) {
  static const ElementMass<nodes> unit = [] {
    ElementMass<nodes> sum = ElementMass<nodes>::Zero();
    for (const auto& q : rule_of_size<dimension>(Simplex<dimension, nodes>::quadratic ? 4 : 2)) {
      const auto N = Simplex<dimension, nodes>::values(q.xi);
      for (int a = 0; a < nodes; ++a)
        for (int b = 0; b < nodes; ++b) sum(a, b) += q.weight * N[a] * N[b];
    }
    return sum;
  }();
  if (straight<dimension, nodes>(points, ids))
    return density * jacobian<dimension, nodes>(points, ids, {}).determinant() * unit;
  return consistent_mass<dimension, nodes>(points, ids, [density](const Vec3&) { return density; });
}

/// Diagonal mass: the diagonal of the consistent matrix scaled to the element's mass. Positive for every element, and
/// equal to the row sums for tet4 (Hinton, Rock and Zienkiewicz 1976, doi 10.1002/eqe.4290040305).
template <int nodes>
ElementMass<nodes> lumped_mass(const ElementMass<nodes>& consistent) {
  double total = 0, diagonal = 0;
  for (int a = 0; a < nodes; ++a) {
    diagonal += consistent(a, a);
    for (int b = 0; b < nodes; ++b) total += consistent(a, b);
  }
  ElementMass<nodes> M = ElementMass<nodes>::Zero();
  if (diagonal > 0) M.diagonal() = consistent.diagonal() * (total / diagonal);
  return M;
}

/// The densities of a model's regions.
class Densities {
 public:
  explicit Densities(const Model& model) {
    for (const Region& region : model.regions) regions_.push_back({region.density, region.density_at});
  }
  /// The mass of an element, a cell of the mesh with points `ids`; `scale` is a thickness.
  template <int dimension, int nodes>
  ElementMass<nodes> mass(const Points& points, const int* ids, int region, int element, bool lumped,
                          double scale = 1) const {
    const double constant = regions_[static_cast<std::size_t>(region)].first;
    const auto& at = regions_[static_cast<std::size_t>(region)].second;
    const auto density = [&](const Vec3& X) { return scale * at(element, X); };
    const ElementMass<nodes> M = at ? consistent_mass<dimension, nodes>(points, ids, density)
                                    : consistent_mass<dimension, nodes>(points, ids, scale * constant);
    return lumped ? lumped_mass<nodes>(M) : M;
  }

 private:
  std::vector<std::pair<double, decltype(Region::density_at)>> regions_;
};

}  // namespace msml::fe
