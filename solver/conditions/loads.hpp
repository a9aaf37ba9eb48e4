// SPDX-License-Identifier: GPL-3.0-or-later
// External forces of one step: gravity, nodal forces, tractions, dead and follower pressure.
#pragma once
#include <vector>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// A side of an element with a pressure that follows the deformed surface.
struct FollowerFace {
  CellKind kind = CellKind::tri3;  ///< tri3, tri6; line2, line3 of plane bodies; vertex of lines
  int count = 0;                   ///< nodes
  int nodes[6] = {};               ///< numbered nodes, in the order of side_nodes: the outside is on the right of edges
  int end = 0;                     ///< of lines: 0 looks to -x, 1 to +x
  double thickness = 1;            ///< of plane bodies; cross-section of lines
  double pressure = 0;
};

/// Everything that pulls or pushes in one step.
struct LoadSet {
  Vector dead;  ///< 3 per numbered node: what does not depend on the displacement
  std::vector<FollowerFace> followers;
};

/// `mass` is the matrix of the equations of motion: gravity is M g, so that a free body falls without deforming.
/// Throws Error where a force acts on a node that belongs to no element.
LoadSet make_loads(const Model& model, const Step& step, const Numbering& numbering, const ScalarMatrix& mass);

/// force += scale * follower forces at positions X + u: f_a = -p int N_a (x,r cross x,s) dr ds. If matrix is given,
/// adds scale * (-df/du). It is symmetric only where the pressure is uniform and the rim of the loaded surface is held
/// or closed (Schweizerhof and Ramm 1984, doi 10.1016/0045-7949(84)90174-0); in a slender body the rest is not small.
void add_followers(const LoadSet& loads, double scale, const Vector& X, const Vector& u, Vector& force,
                   BlockMatrix* matrix);

}  // namespace msml::fe
