// SPDX-License-Identifier: GPL-3.0-or-later
// Area, force and moment on a plane through the body over time.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>

#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/section_faces.hpp"
#include "operators/simulate/spots.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/elements/shapes.hpp"
#include "solver/materials/law.hpp"

namespace msml::simulation {
namespace {

/// A part of the section in one element: a triangle, in the plane a segment, on a line a point.
struct Piece {
  int element;
  double area;                  ///< in the reference configuration
  std::vector<double> weights;  ///< of the element's nodes at the middle of the piece
};

Piece piece_of(const Mesh& mesh, int element, double thickness, const Facet& facet) {
  const auto x = [&](std::size_t i) { return position(mesh, element, facet[i]); };
  double area = thickness;
  if (facet.size() == 2) area *= (x(1) - x(0)).norm();
  if (facet.size() == 3) area = 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  Barycentric middle{};
  for (const Barycentric& end : facet)
    for (std::size_t a = 0; a < 4; ++a) middle[a] += end[a] / static_cast<double>(facet.size());
  return {element, area, shape_weights(mesh.kinds[static_cast<std::size_t>(element)], middle)};
}

std::vector<Piece> cut(const Body& body, double thickness, const CuttingPlane& plane) {
  std::vector<Piece> pieces;
  for (const int element : body.elements) {
    if (side_of(*body.mesh, element, plane) != PlaneSide::both) continue;
    for (const Facet& facet : cut_element(*body.mesh, element, plane).section)
      if (Piece piece = piece_of(*body.mesh, element, thickness, facet); piece.area > 0) pieces.push_back(piece);
  }
  return pieces;
}

/// A function on the points of the body's mesh: 1 at corners on the side of the normal, else 0; at mid nodes the mean
/// of the corners of the edge.
std::vector<double> sides(const Body& body, const CuttingPlane& plane) {
  const Mesh& mesh = *body.mesh;
  std::vector<double> side(static_cast<std::size_t>(mesh.point_count()), 0);
  const int corners = corner_count(body.kind);
  for (const int element : body.elements) {
    const int* nodes = mesh.cell(element);
    const auto at = [&](int a) -> double& { return side[static_cast<std::size_t>(nodes[a])]; };
    for (int a = 0; a < corners; ++a) at(a) = plane.distance(mesh.points.row(nodes[a]).transpose()) < 0 ? 0 : 1;
    for (int m = corners; m < node_count(body.kind); ++m) {
      const auto& edge =
          fe::Simplex<3, 10>::edges[static_cast<std::size_t>(body.kind == CellKind::line3 ? 0 : m - corners)];
      at(m) = 0.5 * (at(edge[0]) + at(edge[1]));
    }
  }
  return side;
}

/// An element in which that function is not constant.
struct Bridge {
  int element;
  Vec3 slope;                               ///< its gradient, from the corners
  Eigen::Matrix<double, 3, 4> gradients{};  ///< of the barycentric coordinates
};

std::vector<Bridge> bridges(const Mesh& mesh, const std::vector<int>& elements, const std::vector<double>& side) {
  std::vector<Bridge> found;
  for (const int element : elements) {
    const int* nodes = mesh.cell(element);
    Mat3 edges = Mat3::Identity();
    Vec3 steps = Vec3::Zero();
    for (int a = 1; a < corner_count(mesh.kinds[static_cast<std::size_t>(element)]); ++a) {
      edges.row(a - 1) = mesh.points.row(nodes[a]) - mesh.points.row(nodes[0]);
      steps[a - 1] = side[static_cast<std::size_t>(nodes[a])] - side[static_cast<std::size_t>(nodes[0])];
    }
    if (!(steps.norm() > 0)) continue;
    const Mat3 inverse = edges.inverse();
    Bridge bridge{element, inverse * steps};
    bridge.gradients << -inverse.rowwise().sum(), inverse;
    found.push_back(bridge);
  }
  return found;
}

/// Mean over an element of a quantity given at its nodes: weight of corners and of mid nodes.
Vec3 mean_over(const Mesh& mesh, int element, const Points& values) {
  const CellKind kind = mesh.kinds[static_cast<std::size_t>(element)];
  constexpr double corner_weights[] = {0, 1.0 / 6, 0, -1.0 / 20}, mid_weights[] = {0, 2.0 / 3, 1.0 / 3, 1.0 / 5};
  const int corners = corner_count(kind), nodes = node_count(kind);
  Vec3 mean = Vec3::Zero();
  for (int a = 0; a < nodes; ++a) {
    const double weight = nodes == corners ? 1.0 / corners
                          : a < corners    ? corner_weights[dimension(kind)]
                                           : mid_weights[dimension(kind)];
    mean += weight * values.row(mesh.cell(element)[a]).transpose();
  }
  return mean;
}

/// The i-th of tensors of nine components.
Mat3 tensor(const std::vector<double>& values, std::size_t i) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data() + 9 * i);
}

constexpr fe::ElementRequest needed{
    .law = false, .J = false, .rotation = false, .tensors = true, .volume = true, .stress_moments = true};

/// Moments of the nodal forces of a linear element about `centre`, with those arms. With the arms of a rigid motion
/// cut off node by node these are in balance with the loads on the nodes of one side, on the coarsest of meshes.
Vec3 nodal_moment(const Mesh& mesh, const Bridge& bridge, const fe::ElementResults& results, const Points& arms) {
  const auto e = static_cast<std::size_t>(bridge.element);
  const Mat3 P = tensor(results.first_piola, e);
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < corner_count(mesh.kinds[e]); ++a) {
    const Vec3 arm = arms.row(mesh.cell(bridge.element)[a]).transpose();
    sum += arm.cross(results.volume[e] * (P * bridge.gradients.col(a)));
  }
  return sum;
}

/// Adds the work of the stress as the function moves the body: along each axis, and turning about `centre`. `arms` are
/// the function times the positions seen from there.
void add_pull(const Mesh& mesh, const std::vector<Bridge>& bridges, const fe::ElementResults& results, const Points& x,
              const Vec3& centre, const Points& arms, Pull& sum) {
  for (const Bridge& bridge : bridges) {
    const auto e = static_cast<std::size_t>(bridge.element);
    const Vec3 pull = results.volume[e] * (tensor(results.first_piola, e) * bridge.slope);
    sum.force += pull;
    if (node_count(mesh.kinds[e]) == corner_count(mesh.kinds[e])) {
      sum.moment += nodal_moment(mesh, bridge, results, arms);
      continue;
    }
    sum.moment += (mean_over(mesh, bridge.element, x) - centre).cross(pull);
    for (std::size_t j = 0; j < 3; ++j)
      sum.moment +=
          Vec3::Unit(static_cast<Eigen::Index>(j)).cross(tensor(results.stress_moments, 3 * e + j) * bridge.slope);
  }
}

/// A mesh embedded in the body, with what of it the plane cuts.
class Inner {
 public:
  Inner(const fe::Model& body, const fe::Inlay& inlay, const CuttingPlane& plane, const std::vector<double>& side)
      : body_(body),
        ties_(inlay.ties),
        model_{.mesh = inlay.mesh, .regions = {inlay.region}, .settings = body.settings} {
    elements_ = fe::make_elements(model_);
    std::vector<double> own(ties_.size(), 0);
    for (std::size_t n = 0; n < own.size(); ++n)
      follow(n, [&](int node, double weight) { own[n] += weight * side[static_cast<std::size_t>(node)]; });
    bridges_ = bridges(*inlay.mesh, inlay.region.elements, own);
    loads_ = std::make_unique<const SectionLoads>(model_, plane, own);
  }

  /// Of a state of the body and the arms of its points.
  void add(const fe::State& body, const Points& displacement, const Vec3& centre, const Points& arms, Pull& sum) const {
    fe::State state;
    state.elements = elements_;
    state.displacement = Points::Zero(model_.mesh->points.rows(), 3);
    Points own = state.displacement;
    for (std::size_t n = 0; n < ties_.size(); ++n)
      follow(n, [&](int node, double weight) {
        state.displacement.row(static_cast<Eigen::Index>(n)) += weight * displacement.row(node);
        own.row(static_cast<Eigen::Index>(n)) += weight * arms.row(node);
      });
    const Points& X = model_.mesh->points;
    const bool small = model_.regions.front().law->small_strain();
    const Points x = small ? X : Points(X + state.displacement);
    add_pull(*model_.mesh, bridges_, fe::element_results(model_, state, needed), x, centre, own, sum);
    const std::vector<ActingStep> acting = acting_steps(body_, body);
    Pull loads;
    loads_->add_masses([&](int n) { return load_on(n, body, acting); }, x, centre, loads);
    sum.force -= loads.force;
    sum.moment -= loads.moment;
  }

 private:
  template <class Visit>
  void follow(std::size_t n, const Visit& visit) const {
    const fe::Tie& tie = ties_[n];
    for (std::size_t a = 0; tie.element >= 0 && a < tie.weights.size(); ++a)
      visit(body_.mesh->cell(tie.element)[a], tie.weights[a]);
  }

  /// Force per mass at a point: it moves with the body.
  Vec3 load_on(int point, const fe::State& state, const std::vector<ActingStep>& acting) const {
    Vec3 load = Vec3::Zero();
    follow(static_cast<std::size_t>(point),
           [&](int node, double weight) { load += weight * force_per_mass(body_, state, acting, node); });
    return load;
  }

  const fe::Model& body_;
  const std::vector<fe::Tie>& ties_;
  fe::Model model_;
  std::shared_ptr<const fe::Elements> elements_;
  std::vector<Bridge> bridges_;
  std::unique_ptr<const SectionLoads> loads_;
};

class SectionWriter final : public TableWriter {
 public:
  SectionWriter(const Simulation& simulation, const OutputRequest& request, const std::filesystem::path& folder)
      : TableWriter(request, folder,
                    {"time", "area", "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"}),
        model_(simulation.model),
        body_(simulation.body),
        normal_(request.normal.normalized()) {
    const CuttingPlane plane{*request.point, normal_, 1e-10 * diagonal(*body_.mesh)};
    pieces_ = cut(body_, simulation.model.thickness, plane);
    side_ = sides(body_, plane);
    bridges_ = bridges(*body_.mesh, body_.elements, side_);
    for (const fe::Inlay& inlay : simulation.model.inlays)
      inlays_.push_back(std::make_unique<Inner>(model_, inlay, plane, side_));
    loads_ = std::make_unique<const SectionLoads>(model_, plane, side_);
    faces_ = std::make_unique<const SectionFaces>(model_, plane, side_);
    if (pieces_.empty())
      refuse(*request.record, fmt::format("the plane through {} with the normal {} misses the body, which spans {}",
                                          place(*request.point), place(normal_), bounds(body_)));
  }

 private:
  std::vector<std::vector<double>> rows(const fe::State& state, StateFields& fields) const override {
    const Points x = body_.small_strain ? body_.mesh->points : fields.positions();
    const fe::ElementResults results = fields.measure(needed);
    const auto [area, centroid] = deformed(results.deformation_gradient, x);
    Pull sum;
    Points arms = x.rowwise() - centroid.transpose();
    for (Eigen::Index n = 0; n < arms.rows(); ++n) arms.row(n) *= side_[static_cast<std::size_t>(n)];
    add_pull(*body_.mesh, bridges_, results, x, centroid, arms, sum);
    for (const auto& inlay : inlays_) inlay->add(state, fields.positions() - body_.mesh->points, centroid, arms, sum);
    const Pull loads = loads_between(state, x, centroid);
    const Vec3 f = sum.force - loads.force, m = sum.moment - loads.moment;
    return {{state.time, area, f[0], f[1], f[2], m[0], m[1], m[2]}};
  }

  /// What acts between the plane and the nodes.
  Pull loads_between(const fe::State& state, const Points& x, const Vec3& centre) const {
    const std::vector<ActingStep> acting = acting_steps(model_, state);
    Points per_mass = Points::Zero(x.rows(), 3);
    for (const int n : loads_->points()) per_mass.row(n) = force_per_mass(model_, state, acting, n).transpose();
    Pull sum;
    loads_->add_masses([&](int n) -> Vec3 { return per_mass.row(n).transpose(); }, x, centre, sum);
    for (const ActingStep& each : acting)
      for (const fe::BodyForce& force : each.step->body_forces)
        loads_->add_body_force(force, each.factor(force, state.time), state.time, x, centre, sum);
    faces_->add(state, acting, x, centre, sum);
    return sum;
  }

  /// Area of the deformed section and its centroid.
  std::pair<double, Vec3> deformed(const std::vector<double>& gradients, const Points& positions) const {
    double area = 0;
    Vec3 centroid = Vec3::Zero();
    for (const Piece& piece : pieces_) {
      Vec3 x = Vec3::Zero();
      for (std::size_t a = 0; a < piece.weights.size(); ++a)
        x += piece.weights[a] * positions.row(body_.mesh->cell(piece.element)[a]).transpose();
      const Mat3 F = tensor(gradients, static_cast<std::size_t>(piece.element));
      Mat3 cofactors;
      cofactors << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
      const double part = piece.area * (cofactors * normal_).norm();
      area += part;
      centroid += part * x;
    }
    return {area, area > 0 ? Vec3(centroid / area) : Vec3(Vec3::Zero())};
  }

  const fe::Model& model_;
  const Body& body_;
  Vec3 normal_;
  std::vector<Piece> pieces_;
  std::vector<double> side_;
  std::vector<Bridge> bridges_;
  std::unique_ptr<const SectionLoads> loads_;
  std::unique_ptr<const SectionFaces> faces_;
  std::vector<std::unique_ptr<const Inner>> inlays_;  // in their places: they hold what points at themselves
};

}  // namespace

std::unique_ptr<OutputWriter> make_section(const Simulation& simulation, const OutputRequest& request,
                                           const std::filesystem::path& folder) {
  return std::make_unique<SectionWriter>(simulation, request, folder);
}

}  // namespace msml::simulation
