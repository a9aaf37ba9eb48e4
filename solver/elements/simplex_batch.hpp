// SPDX-License-Identifier: GPL-3.0-or-later
// Eight elements as loops find them.
#pragma once
#include "solver/elements/prony_history.hpp"
#include "solver/elements/region_laws.hpp"
#include "solver/elements/simplex_kernels.hpp"

namespace msml::fe {

/// Eight elements of one region side by side. Unused lanes of the last batch repeat an element with weight 0.
template <int dimension, int nodes, int rule_points>
struct SimplexBatch {
  struct Point {
    Lanes inverse[dimension * dimension];  ///< dxi/dX, row by row
    Lanes weight;                          ///< reference volume of the point
  };
  using Positions = std::array<int, nodes * nodes>;  ///< of block (a, b) of an element in the pattern, at a * nodes + b
  // First what forces need, with nothing else in between.
  int region = 0, count = 0;
  int first = 0;             ///< place in Numbering::elements of lane 0; the lanes follow
  bool straight = true;      ///< dxi/dX is the same at all points
  int node[lanes][nodes];    ///< numbered nodes
  const Law* law = nullptr;  ///< of all points; null where there are several
  Point points[rule_points];
  const Lanes* inverse(int q) const { return points[straight ? 0 : q].inverse; }
  const Positions* position = nullptr;  ///< of each lane
  BatchLaws laws;
  PronyHistory history;      ///< empty where elastic
  double stored_beside = 0;  ///< see Elements::stored_beside
};

}  // namespace msml::fe
