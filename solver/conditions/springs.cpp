// SPDX-License-Identifier: GPL-3.0-or-later
// Forces, tangents and damping of springs.
#include "solver/conditions/springs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

Vec3 place(const Vector& X, const Vector& u, int node) { return X.segment<3>(3 * node) + u.segment<3>(3 * node); }

/// From the first end to the second, in the deformed state.
Vec3 span(const SpringLink& spring, const Vector& X, const Vector& u) {
  return (spring.second < 0 ? spring.point : place(X, u, spring.second)) - place(X, u, spring.first);
}

/// A length below which a spring has no direction.
double tiny(const SpringLink& spring) { return 1e-12 * spring.rest; }

void add_block(BlockMatrix& matrix, int row, int column, const Mat3& block) {
  double* out = matrix.values.data() + 9 * static_cast<std::size_t>(matrix.pattern->find(row, column));
  for (int k = 0; k < 9; ++k) out[k] += block(k / 3, k % 3);
}

/// A matrix between both ends: B at (1, 1) and (2, 2), -B beside the diagonal.
void add_between(const SpringLink& spring, const Mat3& B, BlockMatrix& matrix) {
  add_block(matrix, spring.first, spring.first, B);
  if (spring.second < 0) return;
  add_block(matrix, spring.second, spring.second, B);
  add_block(matrix, spring.first, spring.second, -B);
  add_block(matrix, spring.second, spring.first, -B);
}

}  // namespace

std::vector<SpringLink> make_springs(const Step& step, const Numbering& numbering) {
  std::vector<SpringLink> links;
  const auto number = [&](const Spring& spring, int node) {
    const int found = numbering.number_of[static_cast<std::size_t>(node)];
    if (found < 0)
      throw Error(
          fmt::format("spring '{}' pulls at node {}, which belongs to no element and has no mass", spring.name, node));
    return found;
  };
  for (const Spring& spring : step.springs)
    links.push_back({number(spring, spring.first), spring.second < 0 ? -1 : number(spring, spring.second), spring.point,
                     spring.stiffness, spring.damping, spring.rest});
  return links;
}

double add_springs(const std::vector<SpringLink>& springs, const Vector& X, const Vector& u, bool definite,
                   Vector& internal, BlockMatrix* tangent) {
  double energy = 0;
  for (const SpringLink& spring : springs) {
    const Vec3 along = span(spring, X, u);
    const double length = along.norm(), stretch = length - spring.rest;
    energy += 0.5 * spring.stiffness * stretch * stretch;
    if (length <= tiny(spring)) {
      if (tangent) add_between(spring, spring.stiffness * Mat3::Identity(), *tangent);
      continue;
    }
    const Vec3 d = along / length;
    const double tension = spring.stiffness * stretch;
    internal.segment<3>(3 * spring.first) -= tension * d;
    if (spring.second >= 0) internal.segment<3>(3 * spring.second) += tension * d;
    if (!tangent) continue;
    const double across = (definite ? std::max(0.0, tension) : tension) / length;
    const Mat3 line = d * d.transpose();
    add_between(spring, spring.stiffness * line + across * (Mat3::Identity() - line), *tangent);
  }
  return energy;
}

void add_dampers(const std::vector<SpringLink>& springs, const Vector& X, const Vector& u, BlockMatrix& damping) {
  for (const SpringLink& spring : springs) {
    if (spring.damping == 0) continue;
    const Vec3 along = span(spring, X, u);
    const double length = along.norm();
    const bool all = spring.rest == 0 || length <= tiny(spring);
    const Vec3 d = all ? Vec3::Zero() : Vec3(along / length);
    add_between(spring, spring.damping * (all ? Mat3(Mat3::Identity()) : Mat3(d * d.transpose())), damping);
  }
}

}  // namespace msml::fe
