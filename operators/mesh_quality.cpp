// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas for the shape of tetrahedra.
#include "operators/mesh_quality.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

using Corners = Eigen::Matrix<double, 4, 3>;
constexpr double largest = 1e300;

double ratio(double a, double b) { return b > 0 && a / b < largest ? a / b : largest; }

/// Normal of the face opposite corner i, twice its area long, pointing outwards for a positive tetrahedron.
Vec3 face_normal(const Corners& p, int i) {
  const auto& f = tet_faces[static_cast<std::size_t>(i)];
  const Vec3 a = p.row(f[0]), b = p.row(f[1]), c = p.row(f[2]);
  return (b - a).cross(c - a);
}

/// Circumradius: |a|^2 (b x c) + |b|^2 (c x a) + |c|^2 (a x b), over 2 det(a, b, c), for the edges a, b, c at corner 0
/// (the centre x solves 2 x.a = |a|^2 and so on; Cramer).
double circumradius(const Corners& p) {
  const Vec3 a = p.row(1) - p.row(0), b = p.row(2) - p.row(0), c = p.row(3) - p.row(0);
  const Vec3 numerator = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  return ratio(numerator.norm(), 2 * std::abs(a.dot(b.cross(c))));
}

void dihedral_angles(const Corners& p, TetQuality& q) {
  q.min_dihedral = 180;
  q.max_dihedral = 0;
  std::array<Vec3, 4> normals;
  for (int i = 0; i < 4; ++i) normals[static_cast<std::size_t>(i)] = face_normal(p, i);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      // Outward normals enclose the supplement of the inner angle; atan2 stays exact near 0 and 180 degrees.
      const double angle = std::atan2(normals[i].cross(normals[j]).norm(), -normals[i].dot(normals[j]));
      const double degrees = angle * 180 / std::numbers::pi;
      q.min_dihedral = std::min(q.min_dihedral, degrees);
      q.max_dihedral = std::max(q.max_dihedral, degrees);
    }
}

double scaled_jacobian(const Corners& p) {
  double smallest = largest;
  const double det = 6 * volume(p);
  for (int i = 0; i < 4; ++i) {
    double product = 1;
    for (int j = 0; j < 4; ++j)
      if (j != i) product *= (p.row(j) - p.row(i)).norm();
    smallest = std::min(smallest, product > 0 ? std::numbers::sqrt2 * det / product : 0);
  }
  return smallest;
}

}  // namespace

TetQuality quality_of(const Corners& p) {
  TetQuality q;
  q.volume = volume(p);
  double shortest = largest, longest = 0, area = 0;
  for (int i = 0; i < 4; ++i) {
    area += face_normal(p, i).norm() / 2;
    for (int j = i + 1; j < 4; ++j) {
      const double length = (p.row(i) - p.row(j)).norm();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
  }
  const double R = circumradius(p), r = area > 0 ? 3 * std::abs(q.volume) / area : 0;
  q.edge_ratio = ratio(longest, shortest);
  q.radius_ratio = ratio(R, 3 * r);
  q.radius_edge = ratio(R, shortest);
  q.scaled_jacobian = scaled_jacobian(p);
  dihedral_angles(p, q);
  return q;
}

TetQuality quality_of(const Eigen::Matrix<double, 10, 3>& nodes) {
  TetQuality q = quality_of(Corners(nodes.topRows<4>()));
  q.volume = curved_volume(nodes);
  const double mean = 6 * q.volume, bound = jacobian_bound(nodes);
  q.scaled_jacobian = mean > 0 ? std::abs(q.scaled_jacobian) * bound / mean : std::min(q.scaled_jacobian, 0.0);
  return q;
}

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{{"volume", &TetQuality::volume, true, 0},
                                        {"edgeRatio", &TetQuality::edge_ratio, false, 1},
                                        {"minDihedralAngle", &TetQuality::min_dihedral, true, 70.528779},
                                        {"maxDihedralAngle", &TetQuality::max_dihedral, false, 70.528779},
                                        {"radiusRatio", &TetQuality::radius_ratio, false, 1},
                                        {"radiusEdgeRatio", &TetQuality::radius_edge, false, 0.61237244},
                                        {"scaledJacobian", &TetQuality::scaled_jacobian, true, 1}};
  return all;
}

Statistics statistics(std::vector<double> values, double low, double high, int bins) {
  std::sort(values.begin(), values.end());
  Statistics s{.min = values.front(), .mean = 0, .max = values.back(), .low = low, .high = high};
  for (const double v : values) s.mean += v / static_cast<double>(values.size());
  for (std::size_t i = 0; i < s.percentiles.size(); ++i) {
    const double place = Statistics::at[i] / 100 * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    s.percentiles[i] = values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  }
  s.histogram.assign(static_cast<std::size_t>(bins), 0);
  for (const double v : values) {
    const double bin = std::floor((v - low) / (high - low) * bins);
    ++s.histogram[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1.0))];
  }
  return s;
}

}  // namespace msml::operators
