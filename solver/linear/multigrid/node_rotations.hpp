// SPDX-License-Identifier: GPL-3.0-or-later
// How each node's surroundings have turned.
#pragma once
#include <array>
#include <vector>

#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// The rotation of each node between two placements of the body: the polar part of the sum of
/// (x_m - x_n)(X_m - X_n)^T over its neighbours m (Mueller et al. 2005, doi 10.1145/1073204.1073216). 9 per node, row
/// by row; the identity at nodes with a fixed unknown. A mid node (`ends` as in NodeGeometry) turns with the ends of
/// its edge, by the mean of both rotations: a fit of its own differs from these by what strain does inside elements,
/// and the transfer from corners would see folds.
void node_rotations(const Pattern& pattern, const Vector& X, const Vector& x, const Mask& fixed,
                    const std::vector<std::array<int, 2>>& ends, std::vector<float>& rotations);

}  // namespace msml::fe
