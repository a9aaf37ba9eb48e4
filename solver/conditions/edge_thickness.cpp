// SPDX-License-Identifier: GPL-3.0-or-later
// Stretches across the plane at the edges of triangles.
#include "solver/conditions/edge_thickness.hpp"

#include <algorithm>

#include "solver/conditions/side_points.hpp"
#include "solver/elements/region_laws.hpp"
#include "solver/materials/plane_stress.hpp"

namespace msml::fe {
namespace {

/// Position in the reference triangle at s along an edge.
Rule<2>::value_type point_of_edge(int local, double s) {
  constexpr double corners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const auto ends = side_nodes(CellKind::tri3, local);
  const double *from = corners[ends[0]], *to = corners[ends[1]];
  return {.xi = {from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])}, .weight = 0};
}

template <int nodes>
void shape_gradients(const Mesh& mesh, const Face& face, const std::vector<double>& along,
                     std::vector<std::array<Lanes, 2>>& gradients, std::vector<Vec3>& places) {
  gradients.assign(nodes, {});
  const int* ids = mesh.cell(face.element);
  for (std::size_t k = 0; k < along.size(); ++k) {
    const auto xi = point_of_edge(face.local, along[k]).xi;
    const auto inverse = jacobian<2, nodes>(mesh.points, ids, xi).inverse().eval();
    const auto reference = Simplex<2, nodes>::gradients(xi);
    places.push_back(place<2, nodes>(mesh.points, ids, xi));
    for (std::size_t a = 0; a < nodes; ++a)
      for (int i = 0; i < 2; ++i)
        gradients[a][static_cast<std::size_t>(i)][k] =
            reference[a][0] * inverse(0, i) + reference[a][1] * inverse(1, i);
  }
}

}  // namespace

EdgeThickness::EdgeThickness(const Model& model, const Region& region, const Numbering& numbering, const Face& face,
                             bool varying) {
  const bool quadratic = numbering.kind == CellKind::tri6;
  std::vector<double> along;
  for (const auto& q : edge_rule(quadratic ? 3 : 2, varying)) along.push_back(q.xi[0]);
  std::vector<Vec3> places;
  if (quadratic)
    shape_gradients<6>(*model.mesh, face, along, gradients_, places);
  else
    shape_gradients<3>(*model.mesh, face, along, gradients_, places);
  for (std::size_t a = 0; a < gradients_.size(); ++a)
    nodes_.push_back(numbering.number_of[static_cast<std::size_t>(model.mesh->cell(face.element)[a])]);
  if (region.point_law)
    law_ = region.point_law({&face.element, 1}, places);
  else
    law_ = region.local_law ? region.local_law({&face.element, 1}) : region.law;
}

EdgeThickness::Stretch EdgeThickness::at(const Vector& u) const {
  Gradients H{};
  for (std::size_t a = 0; a < nodes_.size(); ++a)
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) H(i, k) += u[3 * nodes_[a] + i] * gradients_[a][static_cast<std::size_t>(k)];
  const Thinning found = thinning(*law_, H);
  Stretch stretch{found.stretch, {}};
  for (const auto& g : gradients_) {
    auto& slope = stretch.slope.emplace_back();
    for (std::size_t i = 0; i < 2; ++i) slope[i] = found.slope[3 * i] * g[0] + found.slope[3 * i + 1] * g[1];
  }
  return stretch;
}

std::shared_ptr<const EdgeThickness> edge_thickness(const Model& model, const Numbering& numbering, const Face& face,
                                                    bool varying) {
  if (model.plane != Plane::stress || dimension(numbering.kind) != 2) return nullptr;
  const auto owner = std::find_if(model.regions.begin(), model.regions.end(), [&](const Region& region) {
    return std::find(region.elements.begin(), region.elements.end(), face.element) != region.elements.end();
  });
  if (owner == model.regions.end() || owner->law->small_strain()) return nullptr;
  return std::make_shared<const EdgeThickness>(model, *owner, numbering, face, varying);
}

}  // namespace msml::fe
