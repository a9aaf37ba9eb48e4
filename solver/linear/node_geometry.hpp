// SPDX-License-Identifier: GPL-3.0-or-later
// What a matrix does not tell about its nodes.
#pragma once
#include <array>
#include <vector>

#include "solver/block_matrix.hpp"

namespace msml::fe {

/// Where the nodes of a matrix are, for solvers that make smaller problems from it.
struct NodeGeometry {
  Vector positions;  ///< 3 per node, reference
  std::vector<std::array<int, 2>>
      ends;                  ///< of each mid node the ends of its edge; {-1, -1} at other nodes; empty: none
  bool solid = true;         ///< the unknowns are the displacements of a body of tetrahedra
  double poisson_ratio = 0;  ///< the largest of the body
  double smallest_poisson_ratio = 0;
};

}  // namespace msml::fe
