// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dampers between nodes, and from nodes to points in space.
#pragma once
#include <array>
#include <vector>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// A spring in solver numbering; see Spring.
struct SpringLink {
  int first = -1, second = -1;  ///< numbered nodes; second = -1: the other end is `point`
  Vec3 point;
  double stiffness, damping, rest;
  TimeFunction stiffness_at = {}, damping_at = {}, rest_at = {};  ///< if set, instead of the numbers
  bool varies() const { return stiffness_at || damping_at || rest_at; }
};

/// The springs of a step. Throws Error for a node without unknowns.
std::vector<SpringLink> make_springs(const Step& step, const Numbering& numbering);

/// True if a spring changes with time.
bool vary(const std::vector<SpringLink>& springs);

/// internal += forces of the springs at X + u as they are at a time, tangent (if not null) += their derivative; returns
/// their energy, stiffness/2 (l - rest)^2 each. The tangent of a compressed spring is indefinite across its line;
/// `definite` leaves that part out. A spring of length 0 has no direction: its force is 0 and it resists motion in all
/// directions.
double add_springs(const std::vector<SpringLink>& springs, double time, const Vector& X, const Vector& u, bool definite,
                   Vector& internal, BlockMatrix* tangent);

/// damping += the matrix of the dampers at X + u.
void add_dampers(const std::vector<SpringLink>& springs, double time, const Vector& X, const Vector& u,
                 BlockMatrix& damping);

/// Two states of the springs, at displacements `u` of times `time`.
struct SpringMove {
  const Vector &before, &after;
  double from, to;
};

/// What whoever changes the springs puts into them on the way: the change of their energy where they lie, in the mean
/// of both states. With that of the ends' motion it is all of the change.
double work_on_springs(const std::vector<SpringLink>& springs, const Vector& X, const SpringMove& move);

}  // namespace msml::fe
