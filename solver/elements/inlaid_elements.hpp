// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of a body with further meshes embedded in it.
#pragma once
#include <memory>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// The elements of a body and those of its inlays, Model::inlays. With u_s = T u the displacement of an inlay's nodes
/// (T: weights of Inlay::ties), forces, stiffness and mass become f + T^T f_s(T u), K + T^T K_s T and M + T^T M_s T.
/// A lumped mass is shared by the positive weights. `body` numbers the nodes and has the pattern, with the pairs of
/// inlay_links.
std::unique_ptr<Elements> make_inlaid_elements(const Model& model, std::unique_ptr<Elements> body);

/// Pairs of numbered nodes of the body that elements of inlays join, each once.
std::vector<std::array<int, 2>> inlay_links(const Model& model, const Numbering& numbering);

}  // namespace msml::fe
