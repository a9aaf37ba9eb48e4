// SPDX-License-Identifier: GPL-3.0-or-later
// Which unknowns a step fixes, and to what.
#pragma once
#include "solver/conditions/slides.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// A node with a displacement that follows time: factor(t) times the function or the value.
struct MovedNode {
  int node = 0;  ///< numbered
  Vec3 X, value;
  VectorFunction function;
  TimeFunction factor;
  Vec3 at(double time) const;
};

/// The fixed unknowns of a step: values at its start and end. 3 per numbered node.
struct Supports {
  Mask fixed;
  Vector start, end;
  Mask ramped;                     ///< reached linearly over the step; the others at once
  std::vector<MovedNode> moved;    ///< nodes whose displacement is given as a function of time
  std::vector<int> moved_by = {};  ///< per unknown: which of `moved` gives it, -1 = none
  Slides slides = {};
  /// Values at a share of the step in (0, 1] and the time there; entries of free unknowns are 0.
  Vector at(double share, double time) const;
  /// Velocities of the moved unknowns just after a time, by one-sided differences; entries of others stay.
  void set_off(double time, double dt, Vector& velocity) const;
  /// Their accelerations just after a time, by one-sided differences of second order over a tenth of dt.
  void set_off_rates(double time, double dt, Vector& acceleration) const;
  /// Velocities of the moved unknowns at a time and their accelerations at time + shift, by central differences over a
  /// fifth of dt: of second order in dt, as the methods that use them. Entries of other unknowns stay; `given` marks
  /// what is set.
  void drive(double time, double shift, double dt, Vector& velocity, Vector& acceleration, Mask& given) const;
};

/// `u` is the displacement at the start of the step. Where two conditions fix one unknown, the later wins. Nodes that
/// belong to no element are passed over. Unknowns that the problem does not have (Numbering::components) are fixed at
/// 0.
Supports make_supports(const Step& step, const Numbering& numbering, const Vector& u);

}  // namespace msml::fe
