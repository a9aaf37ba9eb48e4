// SPDX-License-Identifier: GPL-3.0-or-later
// How thick a plate in plane stress is along an edge that is pressed.
#pragma once
#include <memory>
#include <vector>

#include "solver/elements/assembly.hpp"

namespace msml::fe {

/// The stretch F_33 across the plane at the quadrature points of an edge, as the law of its element has it where
/// P_33 = 0, so that a pressure acts on the deformed area: its thickness changes as that of the body.
class EdgeThickness {
 public:
  /// `varying` chooses the rule of the edge, see for_edge_points. `face.element` is a triangle of `region`.
  EdgeThickness(const Model& model, const Region& region, const Numbering& numbering, const Face& face, bool varying);

  /// The stretch at each point (lane k for point k), and its derivative by the displacement of each node of the element
  /// (x and y; z takes no part).
  struct Stretch {
    Lanes value;
    std::vector<std::array<Lanes, 2>> slope;
  };
  Stretch at(const Vector& u) const;
  const std::vector<int>& nodes() const { return nodes_; }  ///< numbered nodes of the element

 private:
  std::shared_ptr<const Law> law_;  ///< lane k is point k
  std::vector<int> nodes_;
  std::vector<std::array<Lanes, 2>> gradients_;  ///< dN_a/dX
};

/// The edge's thickness where it changes: plane stress and a law that sees finite strains. Null otherwise.
std::shared_ptr<const EdgeThickness> edge_thickness(const Model& model, const Numbering& numbering, const Face& face,
                                                    bool varying);

}  // namespace msml::fe
