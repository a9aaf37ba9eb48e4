// SPDX-License-Identifier: GPL-3.0-or-later
// Tangents that Newton's method can use where the exact one is indefinite.
#pragma once
#include "solver/materials/law.hpp"

namespace msml::fe {

/// Replaces each lane's tangent by the nearest positive semidefinite one: negative eigenvalues become 0 (Teran,
/// Sifakis, Irving and Fedkiw 2005, doi 10.1145/1073368.1073394). Lanes that are not finite stay as they are.
void make_semidefinite(Response& response);

}  // namespace msml::fe
