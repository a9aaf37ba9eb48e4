// SPDX-License-Identifier: GPL-3.0-or-later
// Saddle systems of mass and volume constraint, and measures of that constraint.
#include "solver/kept_volume.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace msml::fe {
namespace {

/// c(u) at pressures, zero at displacements.
Vector constraint(const Elements& elements, const Vector& u) {
  Vector force = Vector::Zero(u.size());
  elements.add_internal(u, Want::stress, force, nullptr);
  force.head(3 * elements.numbering().body_nodes()).setZero();
  return force;
}

/// Root mean square of |grad w| in each element, or what round-off can make of it.
std::vector<double> gradients(const Elements& elements, const Vector& w) {
  std::vector<double> sizes(elements.numbering().elements.size());
  const double noise = 1e-9 * w.head(3 * elements.numbering().body_nodes()).cwiseAbs().maxCoeff();
  elements.visit_points(w, [&](std::size_t e, const ElementPoints& points) {
    double sum = 0, volume = 0;
    for (int q = 0; q < points.count; ++q) {
      volume += points.weight[q];
      for (const Lanes& entry : points.gradient.c) sum += points.weight[q] * entry[q] * entry[q];
    }
    sizes[e] = std::max(std::sqrt(sum / volume), noise / std::cbrt(volume));
  });
  return sizes;
}

double volume_at(const ElementPoints& points, bool deformed) {
  double volume = 0;
  for (int q = 0; q < points.count; ++q) {
    Mat3 F = Mat3::Identity();
    for (int k = 0; k < 9 && deformed; ++k) F(k / 3, k % 3) += points.gradient.c[k][q];
    volume += points.weight[q] * F.determinant();
  }
  return volume;
}

/// Deformed volume beside the reference volume of each element.
std::vector<double> volumes(const Elements& elements, const Vector& u) {
  std::vector<double> ratios(elements.numbering().elements.size());
  elements.visit_points(u, [&](std::size_t e, const ElementPoints& points) {
    ratios[e] = volume_at(points, true) / volume_at(points, false);
  });
  return ratios;
}

/// The largest gradient that matters: elements of finite modulus may change their volume.
double largest_gradient(const Numbering& numbering, const Mask& open, const std::vector<double>& sizes) {
  double largest = 0;
  for (std::size_t e = 0; e < sizes.size(); ++e)
    if (open[3 * static_cast<std::size_t>(numbering.pressure_nodes[4 * e])]) largest = std::max(largest, sizes[e]);
  return largest;
}

/// From c or its rate: the volume that each row stands for is what it gains as all lengths grow by a third.
VolumeChange judge(const Elements& elements, const Mask& open, const BlockMatrix& tangent, const Vector& u,
                   const Vector& rows, double gradient, const std::function<double(std::size_t)>& change_of) {
  const Numbering& numbering = elements.numbering();
  Vector place = to_vector(numbering, numbering.mesh->points) + u, volume;
  place.tail(place.size() - 3 * numbering.body_nodes()).setZero();
  multiply(tangent, place, volume);
  VolumeChange found{.gradient = gradient};
  int worst = -1;
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (!open[k]) continue;
    const double change = 3 * rows[static_cast<Eigen::Index>(k)] / volume[static_cast<Eigen::Index>(k)];
    if (worst >= 0 && std::abs(change) <= std::abs(found.change)) continue;
    found.change = change;
    worst = static_cast<int>(k / 3);
    if (std::isnan(change)) break;
  }
  found.relative = std::abs(found.change) / gradient;
  double largest = -1;
  for (std::size_t e = 0; e < numbering.elements.size(); ++e)
    for (std::size_t c = 4 * e; c < 4 * e + 4; ++c)
      if (numbering.pressure_nodes[c] == worst && !(std::abs(change_of(e)) <= largest)) {
        found.change = change_of(e);
        largest = std::abs(found.change);
        found.element = numbering.elements[e];
      }
  return found;
}

constexpr double finite_strain = 0.01;  // of differences

}  // namespace

Mask open_pressures(const Numbering& numbering, const BlockMatrix& tangent) {
  Mask open(3 * static_cast<std::size_t>(numbering.nodes()), 0);
  for (int node = numbering.body_nodes(); node < numbering.nodes(); ++node) {
    const auto diagonal = static_cast<std::size_t>(tangent.pattern->diagonal[static_cast<std::size_t>(node)]);
    open[3 * static_cast<std::size_t>(node)] = !(tangent.values[9 * diagonal] < 0);
  }
  return open;
}

Vector second_rate(const Elements& elements, const Vector& u, const Vector& v) {
  const std::vector<double> sizes = gradients(elements, v);
  const double largest = *std::ranges::max_element(sizes);
  if (!(largest > 0)) return Vector::Zero(u.size());
  const double step = finite_strain / largest;
  constexpr double weights[4] = {-490, 270, -27, 2};  // over 180, of the points 0, +-1, +-2, +-3 steps away
  Vector sum = weights[0] * constraint(elements, u);
  for (int k = 1; k <= 3; ++k)
    sum += weights[k] * (constraint(elements, u + k * step * v) + constraint(elements, u - k * step * v));
  return sum / (180 * step * step);
}

Saddle::Saddle(const Equations& equations, const Supports& supports, const Mask& open, LinearSystem& linear,
               BlockMatrix& room)
    : equations_(equations), supports_(supports), linear_(linear), matrix_(room), still_(supports.fixed) {
  const std::size_t body = 3 * static_cast<std::size_t>(equations.numbering().body_nodes());
  for (std::size_t k = body; k < still_.size(); ++k) still_[k] = !open[k];
}

LinearStatus Saddle::factor(const BlockMatrix& tangent) {
  const Pattern& pattern = *tangent.pattern;
  const int body = equations_.numbering().body_nodes();
  const Numbers<double>& mass = equations_.mass().values;
  double coupling = 0;
  matrix_.values = tangent.values;
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int p = pattern.offsets[static_cast<std::size_t>(row)]; p < pattern.offsets[static_cast<std::size_t>(row) + 1];
         ++p) {
      const auto first = matrix_.values.begin() + 9 * static_cast<long>(p);
      const int column = pattern.columns[static_cast<std::size_t>(p)];
      if ((row < body) == (column < body))
        std::fill_n(first, 9, 0.0);
      else
        std::for_each_n(first, 9, [&](double value) { coupling = std::max(coupling, std::abs(value)); });
    }
  const double largest = *std::ranges::max_element(mass);
  if (!(largest > 0 && coupling > 0)) return LinearStatus::singular;
  scale_ = coupling / largest;
  add(matrix_, scale_, equations_.mass());
  supports_.slides.project(matrix_);
  return linear_.factor(matrix_, still_);
}

LinearStatus Saddle::solve(const Vector& right, const Vector& given, Vector& both) {
  const Eigen::Index body = 3 * static_cast<Eigen::Index>(equations_.numbering().body_nodes());
  Vector moved, b = right;
  multiply(matrix_, given, moved);
  b.head(body) *= scale_;
  b -= moved;
  supports_.slides.project(b);
  const LinearStatus status = linear_.solve(b, 1e-13, both);
  if (status != LinearStatus::done) return status;
  both.tail(both.size() - body) /= scale_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(body); ++k)
    if (supports_.fixed[k]) both[static_cast<Eigen::Index>(k)] = given[static_cast<Eigen::Index>(k)];
  return status;
}

VolumeChange volume_change(const Elements& elements, const Mask& open, const BlockMatrix& tangent, const Vector& u) {
  const std::vector<double> ratios = volumes(elements, u);
  const double gradient = largest_gradient(elements.numbering(), open, gradients(elements, u));
  return judge(elements, open, tangent, u, constraint(elements, u), gradient,
               [&](std::size_t e) { return ratios[e] - 1; });
}

VolumeChange volume_rate(const Elements& elements, const Mask& open, const BlockMatrix& tangent, const Vector& u,
                         const Vector& v) {
  const double gradient = largest_gradient(elements.numbering(), open, gradients(elements, v));
  const double step = finite_strain / gradient;
  Vector rates;
  multiply(tangent, v, rates);
  const std::vector<double> after = volumes(elements, u + step * v), before = volumes(elements, u - step * v);
  return judge(elements, open, tangent, u, rates, gradient,
               [&](std::size_t e) { return (after[e] - before[e]) / (2 * step); });
}

}  // namespace msml::fe
