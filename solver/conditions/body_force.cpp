// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates forces over the volumes of elements.
#include "solver/conditions/body_force.hpp"

#include "solver/elements/shapes.hpp"

namespace msml::fe {
namespace {

template <int dimension, int nodes>
void add_element(const Mesh& mesh, int element, double thickness, const BodyForce& b, const Numbering& numbering,
                 double t, Vector& force) {
  static const Rule<dimension> rule = rule_of_size<dimension>(Simplex<dimension, nodes>::quadratic ? 3 : 2);
  const int* ids = mesh.cell(element);
  for (const auto& q : rule) {
    const auto N = Simplex<dimension, nodes>::values(q.xi);
    const Vec3 density = b.function ? b.function(place<dimension, nodes>(mesh.points, ids, q.xi), t) : b.value;
    const double w = thickness * q.weight * jacobian<dimension, nodes>(mesh.points, ids, q.xi).determinant();
    for (std::size_t a = 0; a < N.size(); ++a)
      force.segment<3>(3 * numbering.number_of[static_cast<std::size_t>(ids[a])]) += w * N[a] * density;
  }
}

}  // namespace

void add_body_force(const Mesh& mesh, double thickness, const BodyForce& body_force, const Numbering& numbering,
                    double t, Vector& force) {
  const auto add = [&](auto function, double across) {
    for (const int element : body_force.elements)
      if (numbering.number_of[static_cast<std::size_t>(mesh.cell(element)[0])] >= 0 &&
          mesh.kinds[static_cast<std::size_t>(element)] == numbering.kind)
        function(mesh, element, across, body_force, numbering, t, force);
  };
  switch (numbering.kind) {
    case CellKind::line2:
      return add(add_element<1, 2>, thickness);
    case CellKind::line3:
      return add(add_element<1, 3>, thickness);
    case CellKind::tri3:
      return add(add_element<2, 3>, thickness);
    case CellKind::tri6:
      return add(add_element<2, 6>, thickness);
    case CellKind::tet4:
      return add(add_element<3, 4>, 1);
    case CellKind::tet10:
      return add(add_element<3, 10>, 1);
    default:
      return;  // points have no volume
  }
}

}  // namespace msml::fe
