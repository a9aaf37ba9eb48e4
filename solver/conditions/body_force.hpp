// SPDX-License-Identifier: GPL-3.0-or-later
// Forces per reference volume.
#pragma once
#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// force += int N_a b dV over the elements, b as it is at time t, without the factor; `thickness` is that of triangles,
/// or the cross-section of lines. Exact where b is of degree 2 in linear and of degree 3 in quadratic elements with
/// straight edges. Elements without unknowns are passed over.
void add_body_force(const Mesh& mesh, double thickness, const BodyForce& body_force, const Numbering& numbering,
                    double t, Vector& force);

}  // namespace msml::fe
