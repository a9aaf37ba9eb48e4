// SPDX-License-Identifier: GPL-3.0-or-later
// External forces of one step: gravity, nodal forces, tractions, dead and follower pressure.
#pragma once
#include <functional>
#include <vector>

#include "solver/conditions/edge_thickness.hpp"
#include "solver/conditions/springs.hpp"
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
  std::shared_ptr<const EdgeThickness> stretch = {};  ///< of the thickness; null where that does not change
  int source = -1;  ///< index into LoadSet::sources, whose function and factor give the pressure; -1: `pressure` alone
};

/// Everything that pulls or pushes in one step.
struct LoadSet {
  Vector dead;  ///< 3 per numbered node: what depends neither on the displacement nor on time
  std::vector<FollowerFace> followers;
  std::vector<FaceLoad> sources;    ///< loads with a function or a factor, without faces
  std::vector<SpringLink> springs;  ///< they act in full, and are gone where the set leaves
  std::vector<std::function<void(double t, Vector& force)>> timed;  ///< each adds a dead load as it is at t
};

/// Loads of a step that act at a time: what ramps with its share, what follows time as it is then.
struct ActingLoads {
  const LoadSet* set;
  double share, time;
  bool leaving = false;  ///< of the step before: what follows time has gone, the rest ramps away
};

/// `mass` is the matrix of the equations of motion: gravity is M g, so that a free body falls without deforming.
/// `numbering` and `mass` must outlive the result. Throws Error where a force acts on a node that belongs to no
/// element.
LoadSet make_loads(const Model& model, const Step& step, const Numbering& numbering, const ScalarMatrix& mass);

/// force += the loads that do not depend on the displacement.
void add_dead(const ActingLoads& loads, Vector& force);

/// force += follower forces at positions X + u: f_a = -p int N_a (x,r cross x,s) dr ds. If matrix is given, adds
/// -df/du. Under plane stress with finite strains the thickness of an edge is that of the deformed body, and depends on
/// all nodes of the element. -df/du is symmetric only where the pressure is uniform and the rim of the loaded surface
/// is held or closed (Schweizerhof and Ramm 1984, doi 10.1016/0045-7949(84)90174-0); in a slender body the rest is not
/// small.
void add_followers(const ActingLoads& loads, const Vector& X, const Vector& u, Vector& force, BlockMatrix* matrix);

}  // namespace msml::fe
