// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates loads over nodes and faces.
#include "solver/conditions/loads.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "msml/core/error.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::fe {
namespace {

/// One value for all, or one each.
template <class T>
const T& pick(const std::vector<T>& values, std::size_t i) {
  return values.size() == 1 ? values.front() : values[i];
}

Vec3 at(const Vector& v, int node) { return v.segment<3>(3 * node); }

Mat3 cross(const Vec3& a) {
  Mat3 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// A quadrature point of a side: shape values, their derivatives, and two tangents r and s with outward normal r x s.
/// The second tangent of an edge, and both of an end point, are those of a plate of the model's thickness (a bar of its
/// cross-section), which do not change.
template <int nodes>
struct SidePoint {
  std::array<double, nodes> N{};
  std::array<std::array<double, 2>, nodes> dN{};
  double weight = 1;
  Vec3 r = Vec3::Zero(), s = Vec3::Zero();
};

/// Calls body(point) at each point of a face; `x(a)` is the position of the side's node a. The rules are exact for a
/// quadratic side: degree 2 (N) + 2 (normal).
template <int nodes, class Position, class Body>
void for_face_points(const Position& x, const Body& body) {
  static const Rule<2> rule = collapsed_triangle_rule(nodes == 3 ? 1 : 3);
  for (const auto& q : rule) {
    SidePoint<nodes> point{Triangle<nodes>::values(q.xi), Triangle<nodes>::gradients(q.xi), q.weight};
    for (int a = 0; a < nodes; ++a) {
      point.r += point.dN[a][0] * x(a);
      point.s += point.dN[a][1] * x(a);
    }
    body(point);
  }
}

/// The same for an edge of a triangle; counter-clockwise edges have r x e_z outside.
template <int nodes, class Position, class Body>
void for_edge_points(const Position& x, double thickness, const Body& body) {
  static const Rule<1> rule = line_rule(nodes == 2 ? 1 : 2);
  for (const auto& q : rule) {
    SidePoint<nodes> point{.N = Simplex<1, nodes>::values(q.xi), .weight = q.weight};
    const auto gradients = Simplex<1, nodes>::gradients(q.xi);
    for (int a = 0; a < nodes; ++a) {
      point.dN[a] = {gradients[a][0], 0};
      point.r += point.dN[a][0] * x(a);
    }
    point.s = thickness * Vec3::UnitZ();
    body(point);
  }
}

/// Calls body(point), a generic function, at each quadrature point of a side.
template <class Position, class Body>
void for_side_points(const FollowerFace& face, const Position& x, const Body& body) {
  if (face.kind == CellKind::tri3) return for_face_points<3>(x, body);
  if (face.kind == CellKind::tri6) return for_face_points<6>(x, body);
  if (face.kind == CellKind::line2) return for_edge_points<2>(x, face.thickness, body);
  if (face.kind == CellKind::line3) return for_edge_points<3>(x, face.thickness, body);
  SidePoint<1> point{.N = {1}, .r = (face.end == 0 ? -1.0 : 1.0) * Vec3::UnitY(), .s = face.thickness * Vec3::UnitZ()};
  body(point);
}

FollowerFace side_of(const Model& model, const Face& face, const Numbering& numbering) {
  FollowerFace out{.kind = side_kind(numbering.kind), .end = face.local, .thickness = model.thickness};
  const int* cell = model.mesh->cell(face.element);
  for (const int local : side_nodes(numbering.kind, face.local))
    out.nodes[out.count++] = numbering.number_of[static_cast<std::size_t>(cell[local])];
  return out;
}

void add_dead_face(const Model& model, const FollowerFace& face, const Vec3* traction, const Numbering& numbering,
                   Vector& force) {
  const auto x = [&](int a) -> Vec3 {
    return model.mesh->points.row(numbering.node_of[static_cast<std::size_t>(face.nodes[a])]).transpose();
  };
  for_side_points(face, x, [&](const auto& point) {
    const Vec3 normal = point.r.cross(point.s);
    const Vec3 pull = traction ? Vec3(*traction * normal.norm()) : Vec3(-face.pressure * normal);
    for (std::size_t a = 0; a < point.N.size(); ++a)
      force.segment<3>(3 * face.nodes[a]) += point.weight * point.N[a] * pull;
  });
}

void add_face_load(const Model& model, const FaceLoad& load, const Numbering& numbering, LoadSet& loads) {
  for (std::size_t i = 0; i < load.faces.size(); ++i) {
    FollowerFace face = side_of(model, load.faces[i], numbering);
    if (!load.pressures.empty()) face.pressure = pick(load.pressures, i);
    if (load.follower && load.tractions.empty()) {
      loads.followers.push_back(face);
      continue;
    }
    add_dead_face(model, face, load.tractions.empty() ? nullptr : &pick(load.tractions, i), numbering, loads.dead);
  }
}

/// -df_a/du_b = p int N_a ([x,r]x N_b,s - [x,s]x N_b,r).
void add_follower(const FollowerFace& face, double pressure, const Vector& X, const Vector& u, Vector& force,
                  BlockMatrix* matrix) {
  const auto x = [&](int a) -> Vec3 { return at(X, face.nodes[a]) + at(u, face.nodes[a]); };
  for_side_points(face, x, [&](const auto& point) {
    const Vec3 push = -pressure * point.weight * point.r.cross(point.s);
    for (std::size_t a = 0; a < point.N.size(); ++a) force.segment<3>(3 * face.nodes[a]) += point.N[a] * push;
    if (!matrix) return;
    const Mat3 R = cross(point.r), S = cross(point.s);
    for (std::size_t a = 0; a < point.N.size(); ++a)
      for (std::size_t b = 0; b < point.N.size(); ++b) {
        const Mat3 block = pressure * point.weight * point.N[a] * (R * point.dN[b][1] - S * point.dN[b][0]);
        double* out =
            matrix->values.data() + 9 * static_cast<std::size_t>(matrix->pattern->find(face.nodes[a], face.nodes[b]));
        for (int k = 0; k < 9; ++k) out[k] += block(k / 3, k % 3);
      }
  });
}

/// Takes away what acts on unknowns that the problem does not have.
void drop_absent(const Numbering& numbering, Vector& force) {
  for (int node = 0; node < numbering.nodes(); ++node)
    for (int c = numbering.components; c < 3; ++c) force[3 * node + c] = 0;
}

}  // namespace

LoadSet make_loads(const Model& model, const Step& step, const Numbering& numbering, const ScalarMatrix& mass) {
  LoadSet loads;
  Vector gravity(3 * numbering.nodes());
  for (int n = 0; n < numbering.nodes(); ++n)
    gravity.segment<3>(3 * n) = numbering.scalar ? Vec3::Zero() : step.gravity;
  multiply(mass, gravity, loads.dead);
  for (const NodalForce& force : step.forces)
    for (std::size_t i = 0; i < force.nodes.size(); ++i) {
      const int node = numbering.number_of[static_cast<std::size_t>(force.nodes[i])];
      if (node < 0)
        throw Error(fmt::format("force '{}' acts on node {}, which belongs to no element", force.name, force.nodes[i]));
      loads.dead.segment<3>(3 * node) += pick(force.values, i);
    }
  for (const FaceLoad& load : step.face_loads) add_face_load(model, load, numbering, loads);
  drop_absent(numbering, loads.dead);
  return loads;
}

void add_followers(const LoadSet& loads, double scale, const Vector& X, const Vector& u, Vector& force,
                   BlockMatrix* matrix) {
  if (scale == 0) return;
  for (const FollowerFace& face : loads.followers) add_follower(face, scale * face.pressure, X, u, force, matrix);
}

}  // namespace msml::fe
