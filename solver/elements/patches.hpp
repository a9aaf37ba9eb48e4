// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of neighbouring tetrahedra that share one volume change.
#pragma once
#include <vector>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// Most elements of a patch: two batches.
inline constexpr int patch_limit = 2 * lanes;

/// Places in Numbering::elements (tet4) by patch: every element is in one patch, every patch in one region and
/// connected through faces. Patches grow from the first free element, in the order in which elements are met
/// through faces from the first cell of the mesh on, by the free neighbour that shares most nodes with the patch, up to
/// `size` elements; remainders below half of it join the neighbour with most common faces. `size` in 1 to patch_limit.
/// They depend on the order of the cells, but not on where the body lies or how its nodes are numbered.
std::vector<std::vector<int>> make_patches(const Numbering& numbering, int size);

}  // namespace msml::fe
