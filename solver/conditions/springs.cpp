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

/// The numbers of a spring at a time.
struct Now {
  double stiffness, damping, rest;
  Now(const SpringLink& of, double t)
      : stiffness(of.stiffness_at ? of.stiffness_at(t) : of.stiffness),
        damping(of.damping_at ? of.damping_at(t) : of.damping),
        rest(of.rest_at ? of.rest_at(t) : of.rest) {}
  double tiny() const { return 1e-12 * rest; }  ///< a length below which a spring has no direction
  double energy(double length) const { return 0.5 * stiffness * (length - rest) * (length - rest); }
};

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
                     spring.stiffness, spring.damping, spring.rest, spring.stiffness_at, spring.damping_at,
                     spring.rest_at});
  return links;
}

bool vary(const std::vector<SpringLink>& springs) {
  return std::any_of(springs.begin(), springs.end(), [](const SpringLink& spring) { return spring.varies(); });
}

double add_springs(const std::vector<SpringLink>& springs, double time, const Vector& X, const Vector& u, bool definite,
                   Vector& internal, BlockMatrix* tangent) {
  double energy = 0;
  for (const SpringLink& spring : springs) {
    const Now now(spring, time);
    const Vec3 along = span(spring, X, u);
    const double length = along.norm();
    energy += now.energy(length);
    if (length <= now.tiny()) {
      if (tangent) add_between(spring, now.stiffness * Mat3::Identity(), *tangent);
      continue;
    }
    const Vec3 d = along / length;
    const double tension = now.stiffness * (length - now.rest);
    internal.segment<3>(3 * spring.first) -= tension * d;
    if (spring.second >= 0) internal.segment<3>(3 * spring.second) += tension * d;
    if (!tangent) continue;
    const double across = (definite ? std::max(0.0, tension) : tension) / length;
    const Mat3 line = d * d.transpose();
    add_between(spring, now.stiffness * line + across * (Mat3::Identity() - line), *tangent);
  }
  return energy;
}

void add_dampers(const std::vector<SpringLink>& springs, double time, const Vector& X, const Vector& u,
                 BlockMatrix& damping) {
  for (const SpringLink& spring : springs) {
    const Now now(spring, time);
    if (now.damping == 0) continue;
    const Vec3 along = span(spring, X, u);
    const double length = along.norm();
    const bool all = now.rest == 0 || length <= now.tiny();
    const Vec3 d = all ? Vec3::Zero() : Vec3(along / length);
    add_between(spring, now.damping * (all ? Mat3(Mat3::Identity()) : Mat3(d * d.transpose())), damping);
  }
}

double work_on_springs(const std::vector<SpringLink>& springs, const Vector& X, const SpringMove& move) {
  double work = 0;
  for (const SpringLink& spring : springs) {
    if (!spring.varies()) continue;
    const Now old(spring, move.from), now(spring, move.to);
    for (const Vector* u : {&move.before, &move.after}) {
      const double length = span(spring, X, *u).norm();
      work += 0.5 * (now.energy(length) - old.energy(length));
    }
  }
  return work;
}

}  // namespace msml::fe
