// SPDX-License-Identifier: GPL-3.0-or-later
// A beam whose elements turn and differ: what co-rotated stiffness matrices are tested with.
#pragma once
#include <cmath>

#include "solver/equations.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {

/// A beam of two halves with their own moduli, one of them auxetic (lambda < 0); quadratic elements have a rotation
/// each.
inline Model two_halves(CellKind kind) {
  Model model = beam_model(3, kind, 0.3, Strain::corotated);
  if (kind == CellKind::tet10) model.formulation = Formulation::single_rotation;
  Region soft{.name = "soft",
              .law = make_linear_elastic({.youngs_modulus = 2e4, .poisson_ratio = -0.2, .strain = Strain::corotated}),
              .density = 1000};
  std::vector<int>& all = model.regions[0].elements;
  const auto middle = all.begin() + static_cast<long>(all.size() / 2);
  soft.elements.assign(middle, all.end());
  all.erase(middle, all.end());
  model.regions.push_back(soft);
  return model;
}

/// A bent and twisted state of it.
inline Vector twisted(const Equations& equations) {
  Vector u(equations.size());
  for (Eigen::Index k = 0; k < u.size(); k += 3) {
    const Vec3 X = equations.positions().segment<3>(k);
    const double angle = 8 * X[0];
    u.segment<3>(k) = Vec3(0.1 * X[0], X[1] * (std::cos(angle) - 1) - X[2] * std::sin(angle) + 2 * X[0] * X[0],
                           X[1] * std::sin(angle) + X[2] * (std::cos(angle) - 1));
  }
  return u;
}

/// Largest difference of entries beside the largest entry.
inline double difference(const BlockMatrix& A, const BlockMatrix& B) {
  double largest = 0, apart = 0;
  for (std::size_t k = 0; k < A.values.size(); ++k) {
    largest = std::max(largest, std::abs(A.values[k]));
    apart = std::max(apart, std::abs(A.values[k] - B.values[k]));
  }
  return apart / largest;
}

}  // namespace msml::fe::testing
