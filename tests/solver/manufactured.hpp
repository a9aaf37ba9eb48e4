// SPDX-License-Identifier: GPL-3.0-or-later
// Loads and errors of solutions that are known everywhere, by quadrature of high order.
#pragma once
#include <cmath>
#include <functional>

#include "solver/elements/shapes.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {

using VectorField = std::function<Vec3(const Vec3&)>;
using MatrixField = std::function<Mat3(const Vec3&)>;  ///< row i = gradient of component i

struct Errors {
  double l2 = 0, h1 = 0;  ///< relative; h1 of the gradient alone
};

/// Calls body(ids, N, dN/dX, place, weight) at the points of a rule of degree 2n - 1 in every element.
template <int dimension, int nodes, class Body>
void for_points(const Model& model, int n, const Body& body) {
  const Rule<dimension> rule = rule_of_size<dimension>(n);
  for (const Region& region : model.regions)
    for (const int e : region.elements)
      for (const auto& q : rule) {
        const int* ids = model.mesh->cell(e);
        const auto J = jacobian<dimension, nodes>(model.mesh->points, ids, q.xi);
        const auto inverse = J.inverse().eval();
        const auto reference = Simplex<dimension, nodes>::gradients(q.xi);
        std::array<Vec3, nodes> g;
        for (std::size_t a = 0; a < nodes; ++a) {
          g[a].setZero();
          for (int k = 0; k < dimension; ++k)
            for (int d = 0; d < dimension; ++d) g[a][k] += reference[a][static_cast<std::size_t>(d)] * inverse(d, k);
        }
        body(ids, Simplex<dimension, nodes>::values(q.xi), g, place<dimension, nodes>(model.mesh->points, ids, q.xi),
             q.weight * J.determinant());
      }
}

/// The consistent nodal forces of a force per volume.
template <int dimension, int nodes>
NodalForce volume_load(const Model& model, const VectorField& force) {
  NodalForce load{.name = "volume"};
  load.values.assign(static_cast<std::size_t>(model.mesh->point_count()), Vec3::Zero());
  for (int k = 0; k < model.mesh->point_count(); ++k) load.nodes.push_back(k);
  for_points<dimension, nodes>(model, 5, [&](const int* ids, const auto& N, const auto&, const Vec3& x, double w) {
    for (std::size_t a = 0; a < nodes; ++a) load.values[static_cast<std::size_t>(ids[a])] += w * N[a] * force(x);
  });
  return load;
}

template <int dimension, int nodes>
Errors errors_of(const Model& model, const State& state, const VectorField& u, const MatrixField& gradient) {
  double l2 = 0, size = 0, h1 = 0, slope = 0;
  for_points<dimension, nodes>(model, 5, [&](const int* ids, const auto& N, const auto& g, const Vec3& x, double w) {
    Vec3 found = Vec3::Zero();
    Mat3 H = Mat3::Zero();
    for (std::size_t a = 0; a < nodes; ++a) {
      const Vec3 value = state.displacement.row(ids[a]).transpose();
      found += N[a] * value;
      H += value * g[a].transpose();
    }
    l2 += w * (found - u(x)).squaredNorm();
    size += w * u(x).squaredNorm();
    h1 += w * (H - gradient(x)).squaredNorm();
    slope += w * gradient(x).squaredNorm();
  });
  return {std::sqrt(l2 / size), std::sqrt(h1 / slope)};
}

}  // namespace msml::fe::testing
