// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates surface loads over the faces that a plane cuts, and over their parts on one side.
#include "operators/simulate/section_faces.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "operators/simulate/body.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::simulation {
namespace {

/// A load on a face as it acts at a time.
struct FacePull {
  const fe::FaceLoad& load;
  std::size_t place;
  double factor, time;

  bool follower() const { return load.follower && load.tractions.empty() && !load.traction_function; }
  /// Of a place at rest and a normal as long as the area.
  Vec3 at(const Vec3& X, const Vec3& normal) const {
    if (load.traction_function) return factor * normal.norm() * load.traction_function(X, time);
    if (load.pressure_function) return -factor * load.pressure_function(X, time) * normal;
    if (!load.tractions.empty()) return factor * normal.norm() * pick(load.tractions);
    return -factor * pick(load.pressures) * normal;
  }

 private:
  template <class T>
  const T& pick(const std::vector<T>& values) const {
    return values.size() == 1 ? values.front() : values[place];
  }
};

/// A face: its nodes in a mesh, and the thickness of a body in the plane.
struct Place {
  const Points& X;
  const Points& x;     ///< where the load acts
  const Points& arms;  ///< whose arms count
  const int* ids;
  double thickness;
};

/// Adds sign times the integral over a part of a face; node a counts with weights[a].
template <int dimension, int nodes>
void add_part(const Place& face, const FacePull& pull, const Part& part, double sign, const double* weights,
              const Vec3& centre, Pull& sum) {
  static const fe::Rule<dimension> rule = fe::rule_of_size<dimension>(3);
  const PartMap<dimension> map(part);
  const double size = sign * map.size();
  for (const auto& q : rule) {
    const auto xi = map.at(q.xi);
    const auto N = fe::Simplex<dimension, nodes>::values(xi);
    const auto g = fe::Simplex<dimension, nodes>::gradients(xi);
    Vec3 X = Vec3::Zero(), r = Vec3::Zero(), s = Vec3::Zero(), arm = Vec3::Zero();
    if (dimension == 1) s[2] = face.thickness;
    double share = 0;
    for (std::size_t a = 0; a < nodes; ++a) {
      const Eigen::Index id = face.ids[a];
      X += N[a] * face.X.row(id).transpose();
      r += g[a][0] * face.x.row(id).transpose();
      if (dimension == 2) s += g[a][dimension - 1] * face.x.row(id).transpose();
      const double weight = weights ? weights[a] : 1;
      share += weight * N[a];
      arm += weight * N[a] * (face.arms.row(id).transpose() - centre);
    }
    const Vec3 load = size * q.weight * pull.at(X, r.cross(s));
    sum.force += share * load;
    sum.moment += arm.cross(load);
  }
}

void drop_last(Mesh& mesh) {
  mesh.kinds.pop_back();
  mesh.offsets.pop_back();
  mesh.nodes.resize(static_cast<std::size_t>(mesh.offsets.back()));
  if (!mesh.regions.empty()) mesh.regions.pop_back();
}

using AddPart = void (*)(const Place&, const FacePull&, const Part&, double, const double*, const Vec3&, Pull&);

AddPart adder(CellKind kind) {
  if (kind == CellKind::line2) return add_part<1, 2>;
  if (kind == CellKind::line3) return add_part<1, 3>;
  return kind == CellKind::tri3 ? add_part<2, 3> : add_part<2, 6>;
}

}  // namespace

SectionFaces::SectionFaces(const fe::Model& model, const CuttingPlane& plane, const std::vector<double>& weights)
    : model_(model) {
  for (const fe::Step& step : model.steps)
    for (const fe::FaceLoad& load : step.face_loads)
      for (std::size_t i = 0; i < load.faces.size(); ++i) look(step, load, i, plane, weights);
}

void SectionFaces::look(const fe::Step& step, const fe::FaceLoad& load, std::size_t place, const CuttingPlane& plane,
                        const std::vector<double>& weights) {
  const Mesh& mesh = *model_.mesh;
  const fe::Face& face = load.faces[place];
  const CellKind kind = side_kind(mesh.kinds[static_cast<std::size_t>(face.element)]);
  if (kind == CellKind::vertex) return;
  const std::vector<int> nodes = face_nodes(mesh, face);
  bool counts = false;
  const auto weight = [&](int n) { return weights[static_cast<std::size_t>(n)]; };
  for (const int n : nodes) counts = counts || weight(n) != weight(nodes[0]);
  if (faces_.points.rows() == 0) faces_.points = mesh.points;
  const int cell = faces_.add_cell(kind, nodes.data());
  if (!counts && side_of(faces_, cell, plane) != PlaneSide::both) return drop_last(faces_);
  Face found{&step, &load, place, cell, {}, cut_element(faces_, cell, plane)};
  for (const int n : nodes) found.weights.push_back(weight(n));
  found_.push_back(std::move(found));
}

void SectionFaces::add(const fe::State& state, const std::vector<ActingStep>& acting, const Points& x,
                       const Vec3& centre, Pull& sum) const {
  const Part whole{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  const Points& X = model_.mesh->points;
  const Points moved = X + state.displacement;
  for (const ActingStep& each : acting)
    for (const Face& face : found_) {
      if (face.step != each.step) continue;
      const FacePull pull{*face.load, face.place, each.factor(*face.load, state.time), state.time};
      const Place place{X, pull.follower() ? moved : X, x, faces_.cell(face.cell), model_.thickness};
      const AddPart add_to = adder(faces_.kinds[static_cast<std::size_t>(face.cell)]);
      add_to(place, pull, whole, 1, face.weights.data(), centre, sum);
      for (const Part& part : face.cut.above) add_to(place, pull, part, -1, nullptr, centre, sum);
      for (const Part& part : face.cut.missing) add_to(place, pull, part, 1, nullptr, centre, sum);
    }
}

}  // namespace msml::simulation
