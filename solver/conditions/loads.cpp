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

/// A quadrature point of a face: shape values, their derivatives, and both tangents of the surface.
template <int nodes>
struct FacePoint {
  std::array<double, nodes> N;
  std::array<std::array<double, 2>, nodes> dN;
  double weight;
  Vec3 r, s;
};

/// Calls body(point) at each point; `x(a)` is the position of the face's node a. The rule is exact for a quadratic
/// face: degree 2 (N) + 2 (normal).
template <int nodes, class Position, class Body>
void for_face_points(const Position& x, const Body& body) {
  static const Rule<2> rule = collapsed_triangle_rule(nodes == 3 ? 1 : 3);
  for (const auto& q : rule) {
    FacePoint<nodes> point{Triangle<nodes>::values(q.xi), Triangle<nodes>::gradients(q.xi), q.weight, Vec3::Zero(),
                           Vec3::Zero()};
    for (int a = 0; a < nodes; ++a) {
      point.r += point.dN[a][0] * x(a);
      point.s += point.dN[a][1] * x(a);
    }
    body(point);
  }
}

FollowerFace face_nodes(const Model& model, const Face& face, const Numbering& numbering) {
  FollowerFace out;
  out.count = numbering.kind == CellKind::tet4 ? 3 : 6;
  const int* cell = model.mesh->cell(face.element);
  for (int a = 0; a < out.count; ++a)
    out.nodes[a] =
        numbering.number_of[static_cast<std::size_t>(cell[tet_faces[static_cast<std::size_t>(face.local)][a]])];
  return out;
}

template <int nodes>
void add_dead_face(const Model& model, const FollowerFace& face, const Vec3* traction, const Numbering& numbering,
                   Vector& force) {
  const auto x = [&](int a) -> Vec3 {
    return model.mesh->points.row(numbering.node_of[static_cast<std::size_t>(face.nodes[a])]).transpose();
  };
  for_face_points<nodes>(x, [&](const FacePoint<nodes>& point) {
    const Vec3 normal = point.r.cross(point.s);
    const Vec3 pull = traction ? Vec3(*traction * normal.norm()) : Vec3(-face.pressure * normal);
    for (int a = 0; a < nodes; ++a) force.segment<3>(3 * face.nodes[a]) += point.weight * point.N[a] * pull;
  });
}

void add_face_load(const Model& model, const FaceLoad& load, const Numbering& numbering, LoadSet& loads) {
  for (std::size_t i = 0; i < load.faces.size(); ++i) {
    FollowerFace face = face_nodes(model, load.faces[i], numbering);
    if (!load.pressures.empty()) face.pressure = pick(load.pressures, i);
    if (load.follower && load.tractions.empty()) {
      loads.followers.push_back(face);
      continue;
    }
    const Vec3* traction = load.tractions.empty() ? nullptr : &pick(load.tractions, i);
    if (face.count == 3)
      add_dead_face<3>(model, face, traction, numbering, loads.dead);
    else
      add_dead_face<6>(model, face, traction, numbering, loads.dead);
  }
}

/// -df_a/du_b = p int N_a ([x,r]x N_b,s - [x,s]x N_b,r).
template <int nodes>
void add_follower(const FollowerFace& face, double pressure, const Vector& X, const Vector& u, Vector& force,
                  BlockMatrix* matrix) {
  const auto x = [&](int a) -> Vec3 { return at(X, face.nodes[a]) + at(u, face.nodes[a]); };
  for_face_points<nodes>(x, [&](const FacePoint<nodes>& point) {
    const Vec3 push = -pressure * point.weight * point.r.cross(point.s);
    for (int a = 0; a < nodes; ++a) force.segment<3>(3 * face.nodes[a]) += point.N[a] * push;
    if (!matrix) return;
    const Mat3 R = cross(point.r), S = cross(point.s);
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b) {
        const Mat3 block = pressure * point.weight * point.N[a] * (R * point.dN[b][1] - S * point.dN[b][0]);
        double* out =
            matrix->values.data() + 9 * static_cast<std::size_t>(matrix->pattern->find(face.nodes[a], face.nodes[b]));
        for (int k = 0; k < 9; ++k) out[k] += block(k / 3, k % 3);
      }
  });
}

}  // namespace

LoadSet make_loads(const Model& model, const Step& step, const Numbering& numbering, const ScalarMatrix& mass) {
  LoadSet loads;
  Vector gravity(3 * numbering.nodes());
  for (int n = 0; n < numbering.nodes(); ++n) gravity.segment<3>(3 * n) = step.gravity;
  multiply(mass, gravity, loads.dead);
  for (const NodalForce& force : step.forces)
    for (std::size_t i = 0; i < force.nodes.size(); ++i) {
      const int node = numbering.number_of[static_cast<std::size_t>(force.nodes[i])];
      if (node < 0)
        throw Error(fmt::format("force '{}' acts on node {}, which belongs to no element", force.name, force.nodes[i]));
      loads.dead.segment<3>(3 * node) += pick(force.values, i);
    }
  for (const FaceLoad& load : step.face_loads) add_face_load(model, load, numbering, loads);
  return loads;
}

void add_followers(const LoadSet& loads, double scale, const Vector& X, const Vector& u, Vector& force,
                   BlockMatrix* matrix) {
  if (scale == 0) return;
  for (const FollowerFace& face : loads.followers)
    if (face.count == 3)
      add_follower<3>(face, scale * face.pressure, X, u, force, matrix);
    else
      add_follower<6>(face, scale * face.pressure, X, u, force, matrix);
}

}  // namespace msml::fe
