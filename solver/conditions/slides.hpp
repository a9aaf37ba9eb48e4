// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that slide in planes of any direction.
#pragma once
#include <vector>

#include "solver/elements/assembly.hpp"
#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// Nodes whose displacement stays in a plane or on a line: u = P u, with P the projection on what is free. Positions,
/// forces and matrices keep their global axes; projected, residual and matrix act on the free part alone. Reactions are
/// what the projection takes away.
struct Slides {
  std::vector<int> nodes;        ///< numbered, each once
  std::vector<Mat3> projection;  ///< P, symmetric, of each of `nodes`
  bool empty() const { return nodes.empty(); }
  /// v := P v at the nodes.
  void project(Vector& v) const;
  /// A := P A P + s (I - P), with s the size of the node's own block: regular, and P x for the free part of a solution.
  void project(BlockMatrix& A) const;
  /// v - P v: zero at all other nodes.
  Vector removed(const Vector& v) const;
};

/// What supports do with the unknowns of a step.
struct HeldUnknowns {
  const Mask& fixed;
  const Mask& moves;           ///< 0: to zero; 1: to other values; 2: as a function of time
  const Vector &first, &last;  ///< values at the start of the step and at its end
};

/// The slides of a step. Normals of one node are made orthogonal, so that two planes leave a line and three hold it;
/// components that supports hold anyway are left to them. Throws Error where a support moves a node out of its plane,
/// or may do so: it follows a function of time, or leaves a part of the normal free.
Slides make_slides(const Step& step, const Numbering& numbering, const HeldUnknowns& supports);

}  // namespace msml::fe
