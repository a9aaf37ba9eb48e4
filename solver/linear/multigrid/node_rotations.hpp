// SPDX-License-Identifier: GPL-3.0-or-later
// How each node's surroundings have turned.
#pragma once
#include <vector>

#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// The rotation of each node between two placements of the body: the polar part of the sum of
/// (x_m - x_n)(X_m - X_n)^T over its neighbours m (Mueller et al. 2005, doi 10.1145/1073204.1073216). 9 per node, row
/// by row; the identity at nodes with a fixed unknown.
void node_rotations(const Pattern& pattern, const Vector& X, const Vector& x, const Mask& fixed,
                    std::vector<float>& rotations);

}  // namespace msml::fe
