// SPDX-License-Identifier: GPL-3.0-or-later
// Finds places inside a body.
#include "operators/simulate/spots.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/elements/shapes.hpp"

namespace msml::simulation {
namespace {

/// Reference coordinates of a place, by Newton's method: one iteration where edges are straight.
template <int dimension, int nodes>
Spot spot_in(const Mesh& mesh, int element, const Vec3& x) {
  using Element = fe::Simplex<dimension, nodes>;
  const int* ids = mesh.cell(element);
  std::array<double, dimension> xi;
  xi.fill(1.0 / (dimension + 1));
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Vec3 miss = x - fe::place<dimension, nodes>(mesh.points, ids, xi);
    const Eigen::Matrix<double, dimension, 1> step =
        fe::jacobian<dimension, nodes>(mesh.points, ids, xi).inverse() * miss.template head<dimension>();
    if (!step.allFinite()) return {.element = element, .weights = {}, .outside = 1e300};
    for (int d = 0; d < dimension; ++d) xi[static_cast<std::size_t>(d)] += step[d];
    if (step.norm() < 1e-13) break;
  }
  const auto N = Element::values(xi);
  const auto L = Element::barycentric(xi);
  return {element, {N.begin(), N.end()}, std::max(0.0, -*std::min_element(L.begin(), L.end()))};
}

Spot spot_of(const Mesh& mesh, CellKind kind, int element, const Vec3& x) {
  switch (kind) {
    case CellKind::line2:
      return spot_in<1, 2>(mesh, element, x);
    case CellKind::line3:
      return spot_in<1, 3>(mesh, element, x);
    case CellKind::tri3:
      return spot_in<2, 3>(mesh, element, x);
    case CellKind::tri6:
      return spot_in<2, 6>(mesh, element, x);
    case CellKind::tet4:
      return spot_in<3, 4>(mesh, element, x);
    default:
      return spot_in<3, 10>(mesh, element, x);
  }
}

double squared(double x) { return x * x; }

/// Distance of a place from a triangle (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_edge = [&](const Vec3& s, const Vec3& e) {
    const double length = (e - s).squaredNorm();
    const double at = length > 0 ? std::clamp((p - s).dot(e - s) / length, 0.0, 1.0) : 0.0;
    return (p - s - at * (e - s)).norm();
  };
  Eigen::Matrix<double, 3, 2> edges;
  edges << b - a, c - a;
  const Eigen::Matrix2d gram = edges.transpose() * edges;
  if (gram.determinant() > 1e-24 * squared(gram.trace())) {
    const Eigen::Vector2d at = gram.inverse() * (edges.transpose() * (p - a));
    if (at[0] >= 0 && at[1] >= 0 && at.sum() <= 1) return (p - a - edges * at).norm();
  }
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// The box around an element, a little larger, since quadratic ones bulge.
Eigen::AlignedBox3d around(const Mesh& mesh, int element, double margin) {
  Eigen::AlignedBox3d box;
  for (int a = 0; a < node_count(mesh.kinds[static_cast<std::size_t>(element)]); ++a)
    box.extend(Vec3(mesh.points.row(mesh.cell(element)[a]).transpose()));
  const Vec3 more = 0.1 * box.sizes() + Vec3::Constant(margin);
  return {box.min() - more, box.max() + more};
}

template <int dimension, int nodes>
std::vector<double> weights_at(std::span<const double> barycentric) {
  typename fe::Simplex<dimension, nodes>::Point xi;
  for (std::size_t d = 0; d < dimension; ++d) xi[d] = barycentric[d + 1];
  const auto N = fe::Simplex<dimension, nodes>::values(xi);
  return {N.begin(), N.end()};
}

}  // namespace

SpotFinder::SpotFinder(const Body& body) : body_(body) {
  const Mesh& mesh = *body.mesh;
  Eigen::AlignedBox3d all;
  for (const int e : body.elements) all.extend(around(mesh, e, 0));
  const double margin = 1e-6 * all.diagonal().norm();
  count_ = std::clamp(static_cast<int>(std::cbrt(static_cast<double>(body.elements.size()))), 1, 64);
  low_ = all.min() - Vec3::Constant(margin);
  size_ = (all.sizes() + Vec3::Constant(2 * margin)) / count_;
  boxes_.resize(static_cast<std::size_t>(count_) * static_cast<std::size_t>(count_) * static_cast<std::size_t>(count_));
  for (const int e : body.elements) {
    const Eigen::AlignedBox3d own = around(mesh, e, margin);
    const Box first = box_of(own.min()), last = box_of(own.max());
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k) boxes_[index({i, j, k})].push_back(e);
  }
}

SpotFinder::Box SpotFinder::box_of(const Vec3& x) const {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const double scaled = size_[k] > 0 ? (x[k] - low_[k]) / size_[k] : 0;
    box[static_cast<std::size_t>(k)] = static_cast<int>(std::clamp(scaled, 0.0, count_ - 1.0));
  }
  return box;
}

std::size_t SpotFinder::index(const Box& box) const {
  return static_cast<std::size_t>((box[0] * count_ + box[1]) * count_ + box[2]);
}

Spot SpotFinder::find(const Vec3& x) const {
  Spot best{.element = -1, .weights = {}, .outside = std::numeric_limits<double>::infinity()};
  const auto look = [&](const std::vector<int>& elements) {
    for (const int element : elements) {
      Spot spot = spot_of(*body_.mesh, body_.kind, element, x);
      if (spot.outside < best.outside) best = std::move(spot);
      if (best.outside == 0) return;
    }
  };
  look(boxes_[index(box_of(x))]);
  if (best.outside > 1e-8) look(body_.elements);
  return best;
}

std::vector<double> shape_weights(CellKind kind, std::span<const double> barycentric) {
  switch (kind) {
    case CellKind::line2:
      return weights_at<1, 2>(barycentric);
    case CellKind::line3:
      return weights_at<1, 3>(barycentric);
    case CellKind::tri3:
      return weights_at<2, 3>(barycentric);
    case CellKind::tri6:
      return weights_at<2, 6>(barycentric);
    case CellKind::tet4:
      return weights_at<3, 4>(barycentric);
    default:
      return weights_at<3, 10>(barycentric);
  }
}

double distance_to(const Body& body, const Vec3& x) {
  double least = std::numeric_limits<double>::infinity();
  if (dimension(body.kind) < 3) {
    for (int n = 0; n < body.mesh->point_count(); ++n)
      if (body.solid[static_cast<std::size_t>(n)])
        least = std::min(least, (body.mesh->points.row(n).transpose() - x).norm());
    return least;
  }
  const FaceTable table(body);
  for (const fe::Face& face : table.boundary_faces()) {
    const std::vector<int> n = face_nodes(*body.mesh, face);
    const auto at = [&](std::size_t i) -> Vec3 { return body.mesh->points.row(n[i]).transpose(); };
    least = std::min(least, distance(x, at(0), at(1), at(2)));
  }
  return least;
}

}  // namespace msml::simulation
