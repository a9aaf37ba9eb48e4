// SPDX-License-Identifier: GPL-3.0-or-later
// Loads on surfaces between a plane and the nodes on one side of it.
#pragma once
#include <vector>

#include "operators/simulate/section_loads.hpp"

namespace msml::simulation {

/// What SectionLoads is for volumes, of the faces that tractions and pressures act on: faces of tetrahedra and edges of
/// triangles. The thickness of an edge is that at rest.
class SectionFaces {
 public:
  /// `weights` as of SectionLoads. The model must outlive the faces.
  SectionFaces(const fe::Model& model, const CuttingPlane& plane, const std::vector<double>& weights);
  /// Adds the loads of a state that belong to the nodes less those on that side, and their moment about `centre`, of a
  /// body with points at `x`.
  void add(const fe::State& state, const std::vector<ActingStep>& acting, const Points& x, const Vec3& centre,
           Pull& sum) const;

 private:
  struct Face {
    const fe::Step* step;
    const fe::FaceLoad* load;
    std::size_t place;            ///< among the faces of the load
    int cell;                     ///< of faces_
    std::vector<double> weights;  ///< of its nodes
    ElementCut cut;
  };
  void look(const fe::Step& step, const fe::FaceLoad& load, std::size_t place, const CuttingPlane& plane,
            const std::vector<double>& weights);
  const fe::Model& model_;
  Mesh faces_;  ///< cells are faces that count; points are those of the model's mesh
  std::vector<Face> found_;
};

}  // namespace msml::simulation
