// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates loads over nodes and faces.
#include "solver/conditions/loads.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "msml/core/error.hpp"
#include "solver/conditions/body_force.hpp"
#include "solver/conditions/side_points.hpp"

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

FollowerFace side_of(const Model& model, const Face& face, const Numbering& numbering) {
  FollowerFace out{.kind = side_kind(numbering.kind), .end = face.local, .thickness = model.thickness};
  const int* cell = model.mesh->cell(face.element);
  for (const int local : side_nodes(numbering.kind, face.local))
    out.nodes[out.count++] = numbering.number_of[static_cast<std::size_t>(cell[local])];
  return out;
}

/// Force per area that acts on a face: on its reference area, or times its normal.
using Pull = std::function<Vec3(const Vec3& X, const Vec3& normal)>;

void add_dead_face(const Mesh& mesh, const Numbering& numbering, const FollowerFace& face, const Pull& pull,
                   bool varying, Vector& force) {
  const auto x = [&](int a) -> Vec3 {
    return mesh.points.row(numbering.node_of[static_cast<std::size_t>(face.nodes[a])]).transpose();
  };
  for_side_points(face, x, varying, [&](const auto& point) {
    const Vec3 density = pull(interpolate(point, x), point.r.cross(point.s));
    for (std::size_t a = 0; a < point.N.size(); ++a)
      force.segment<3>(3 * face.nodes[a]) += point.weight * point.N[a] * density;
  });
}

/// The dead load on face i at a time.
Pull pull_of(const FaceLoad& load, std::size_t i, double t) {
  if (load.traction_function)
    return
        [&load, t](const Vec3& X, const Vec3& normal) -> Vec3 { return load.traction_function(X, t) * normal.norm(); };
  if (load.pressure_function)
    return [&load, t](const Vec3& X, const Vec3& normal) -> Vec3 { return -load.pressure_function(X, t) * normal; };
  if (load.tractions.empty())
    return [p = pick(load.pressures, i)](const Vec3&, const Vec3& normal) -> Vec3 { return -p * normal; };
  return [T = pick(load.tractions, i)](const Vec3&, const Vec3& normal) -> Vec3 { return T * normal.norm(); };
}

void add_dead_faces(const Mesh& mesh, const Numbering& numbering, const FaceLoad& load,
                    const std::vector<FollowerFace>& faces, double t, Vector& force) {
  const bool varying = load.traction_function || load.pressure_function;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    add_dead_face(mesh, numbering, faces[i], pull_of(load, i, t), varying, force);
  }
}

/// Puts a dead load where it belongs. `add(t, force)` adds it without the factor; `follows` says that it depends on t.
void add_load(LoadSet& loads, const TimeFunction& factor, bool follows, std::function<void(double, Vector&)> add) {
  if (!factor && !follows) return add(0, loads.dead);
  if (!factor) return loads.timed.push_back(std::move(add));
  if (follows) {
    loads.timed.push_back([add = std::move(add), factor](double t, Vector& force) {
      Vector part = Vector::Zero(force.size());
      add(t, part);
      force += factor(t) * part;
    });
    return;
  }
  Vector pattern = Vector::Zero(loads.dead.size());
  add(0, pattern);
  loads.timed.push_back(
      [pattern = std::move(pattern), factor](double t, Vector& force) { force += factor(t) * pattern; });
}

void add_face_load(const Model& model, const FaceLoad& load, const Numbering& numbering, LoadSet& loads) {
  const bool follower = load.follower && load.tractions.empty() && !load.traction_function;
  const bool source = load.pressure_function || load.factor;
  std::vector<FollowerFace> faces;
  for (const Face& face : load.faces) faces.push_back(side_of(model, face, numbering));
  FaceLoad facts = load;
  facts.faces.clear();
  if (!follower) {
    const bool follows = (load.traction_function || load.pressure_function) && !load.steady;
    const auto add = [mesh = model.mesh, numbers = &numbering, facts, faces](double t, Vector& force) {
      add_dead_faces(*mesh, *numbers, facts, faces, t, force);
    };
    return add_load(loads, load.factor, follows, add);
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!load.pressures.empty()) faces[i].pressure = pick(load.pressures, i);
    if (source) faces[i].source = static_cast<int>(loads.sources.size());
    faces[i].stretch = edge_thickness(model, numbering, load.faces[i], source);
    loads.followers.push_back(faces[i]);
  }
  if (source) loads.sources.push_back(std::move(facts));
}

void add_nodal_force(const Model& model, const NodalForce& force, const Numbering& numbering, LoadSet& loads) {
  std::vector<int> numbers;
  for (const int node : force.nodes) {
    numbers.push_back(numbering.number_of[static_cast<std::size_t>(node)]);
    if (numbers.back() < 0)
      throw Error(fmt::format("force '{}' acts on node {}, which belongs to no element", force.name, node));
  }
  const auto add = [mesh = model.mesh, force, numbers](double t, Vector& sum) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      sum.segment<3>(3 * numbers[i]) +=
          force.function ? force.function(mesh->points.row(force.nodes[i]).transpose(), t) : pick(force.values, i);
  };
  add_load(loads, force.factor, static_cast<bool>(force.function), add);
}

/// The pressure of a follower face at a place, as the loads that act say.
double pressure_at(const ActingLoads& loads, const FollowerFace& face, const Vec3& X) {
  if (face.source < 0) return loads.share * face.pressure;
  const FaceLoad& source = loads.set->sources[static_cast<std::size_t>(face.source)];
  const bool follows = source.factor || !source.steady;
  if (follows && loads.leaving) return 0;
  const double p = source.pressure_function ? source.pressure_function(X, loads.time) : face.pressure;
  return p * (source.factor ? source.factor(loads.time) : 1.0) * (follows ? 1.0 : loads.share);
}

/// -df_a/du_b = p w N_a normal (d stretch/du_b) for all nodes b of the element, at point k of an edge.
template <int nodes>
void add_thinning(const FollowerFace& face, const SidePoint<nodes>& point, const Vec3& push,
                  const EdgeThickness::Stretch& stretch, int k, BlockMatrix& matrix) {
  const std::vector<int>& all = face.stretch->nodes();
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = 0; b < all.size(); ++b) {
      double* out = matrix.values.data() + 9 * static_cast<std::size_t>(matrix.pattern->find(face.nodes[a], all[b]));
      for (Eigen::Index i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 2; ++j)
          out[3 * static_cast<std::size_t>(i) + j] -= point.N[a] * push[i] * stretch.slope[b][j][k];
    }
}

/// -df_a/du_b = p int N_a ([x,r]x N_b,s - [x,s]x N_b,r), and what thinning adds.
void add_follower(const ActingLoads& loads, const FollowerFace& face, const Vector& X, const Vector& u, Vector& force,
                  BlockMatrix* matrix) {
  const auto reference = [&](int a) -> Vec3 { return at(X, face.nodes[a]); };
  const auto x = [&](int a) -> Vec3 { return at(X, face.nodes[a]) + at(u, face.nodes[a]); };
  const auto stretch = face.stretch ? face.stretch->at(u) : EdgeThickness::Stretch{lanes_of(1), {}};
  int index = 0;
  for_side_points(face, x, face.source >= 0, [&](const auto& point) {
    const int k = face.stretch ? index++ : 0;
    const double flat = pressure_at(loads, face, interpolate(point, reference)), pressure = flat * stretch.value[k];
    const Vec3 push = -pressure * point.weight * point.r.cross(point.s);
    for (std::size_t a = 0; a < point.N.size(); ++a) force.segment<3>(3 * face.nodes[a]) += point.N[a] * push;
    if (!matrix) return;
    if (face.stretch) add_thinning(face, point, push / stretch.value[k], stretch, k, *matrix);
    const Mat3 R = cross(point.r), S = cross(point.s);
    for (std::size_t a = 0; a < point.N.size(); ++a)
      for (std::size_t b = 0; b < point.N.size(); ++b) {
        const Mat3 block = pressure * point.weight * point.N[a] * (R * point.dN[b][1] - S * point.dN[b][0]);
        double* out =
            matrix->values.data() + 9 * static_cast<std::size_t>(matrix->pattern->find(face.nodes[a], face.nodes[b]));
        for (int i = 0; i < 9; ++i) out[i] += block(i / 3, i % 3);
      }
  });
}

/// Takes away what acts on unknowns that the problem does not have.
void drop_absent(const Numbering& numbering, Vector& force) {
  for (int node = 0; node < numbering.nodes(); ++node)
    for (int c = numbering.components; c < 3; ++c) force[3 * node + c] = 0;
}

/// M g, g taken at the nodes.
void add_gravity(const Step& step, const Numbering& numbering, const ScalarMatrix& mass, LoadSet& loads) {
  const auto add = [g = step.gravity, at_place = step.gravity_function, numbers = &numbering, M = &mass](
                       double t, Vector& force) {
    Vector gravity = Vector::Zero(force.size()), weight;
    for (int n = 0; n < numbers->body_nodes(); ++n)
      gravity.segment<3>(3 * n) =
          at_place ? at_place(numbers->mesh->points.row(numbers->node_of[static_cast<std::size_t>(n)]).transpose(), t)
                   : g;
    multiply(*M, gravity, weight);
    force += weight;
  };
  add_load(loads, {}, step.gravity_function && !step.gravity_steady, add);
}

}  // namespace

LoadSet make_loads(const Model& model, const Step& step, const Numbering& numbering, const ScalarMatrix& mass) {
  LoadSet loads;
  loads.dead = Vector::Zero(3 * numbering.nodes());
  if (!numbering.scalar) add_gravity(step, numbering, mass, loads);
  loads.springs = make_springs(step, numbering);
  for (const NodalForce& force : step.forces) add_nodal_force(model, force, numbering, loads);
  for (const FaceLoad& load : step.face_loads) add_face_load(model, load, numbering, loads);
  for (const BodyForce& force : step.body_forces) {
    const auto add = [mesh = model.mesh, thickness = model.thickness, numbers = &numbering, force](
                         double t, Vector& sum) { add_body_force(*mesh, thickness, force, *numbers, t, sum); };
    add_load(loads, force.factor, force.function && !force.steady, add);
  }
  drop_absent(numbering, loads.dead);
  if (numbering.components < 3 && !loads.timed.empty())
    loads.timed.emplace_back([numbers = &numbering](double, Vector& force) { drop_absent(*numbers, force); });
  return loads;
}

void add_dead(const ActingLoads& loads, Vector& force) {
  force += loads.share * loads.set->dead;
  if (loads.leaving) return;
  for (const auto& add : loads.set->timed) add(loads.time, force);
}

void add_followers(const ActingLoads& loads, const Vector& X, const Vector& u, Vector& force, BlockMatrix* matrix) {
  for (const FollowerFace& face : loads.set->followers) add_follower(loads, face, X, u, force, matrix);
}

}  // namespace msml::fe
