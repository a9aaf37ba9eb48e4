// SPDX-License-Identifier: GPL-3.0-or-later
// Area, force and moment on a plane through the body over time.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>

#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/spots.hpp"

namespace msml::simulation {
namespace {

using Barycentric = std::array<double, 4>;  ///< of the corners; 0 for those an element does not have

/// A part of the section in one element: a triangle, in the plane a segment, on a line a point.
struct Piece {
  int element;
  double area;                  ///< in the reference configuration
  std::vector<double> weights;  ///< of the element's nodes at the middle of the piece
};

/// The plane in the reference configuration.
struct Plane {
  Vec3 point, normal;  ///< normal of length 1
  double tolerance;    ///< distances below it are 0
  double distance(const Vec3& x) const {
    const double d = normal.dot(x - point);
    return std::abs(d) < tolerance ? 0 : d;
  }
};

/// Where the plane crosses the edges of an element from its side to the side of the normal, in order around the
/// section. A corner on the plane counts to the side of the normal.
std::vector<Barycentric> crossings(const Mesh& mesh, int element, const Plane& plane) {
  const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(element)]);
  std::vector<std::size_t> below, above;
  Barycentric d{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(corners); ++a) {
    d[a] = plane.distance(mesh.points.row(mesh.cell(element)[a]).transpose());
    (d[a] < 0 ? below : above).push_back(a);
  }
  std::vector<Barycentric> found;
  for (std::size_t i = 0; i < below.size(); ++i)
    for (std::size_t j = 0; j < above.size(); ++j) {
      // Back and forth, so that neighbours in the list share a face of a tetrahedron.
      const std::size_t m = below[i], p = above[i % 2 == 0 ? j : above.size() - 1 - j];
      Barycentric at{};
      at[p] = d[m] / (d[m] - d[p]);
      at[m] = 1 - at[p];
      found.push_back(at);
    }
  return found;
}

Vec3 position(const Mesh& mesh, int element, const Barycentric& at) {
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < corner_count(mesh.kinds[static_cast<std::size_t>(element)]); ++a)
    x += at[static_cast<std::size_t>(a)] * mesh.points.row(mesh.cell(element)[a]).transpose();
  return x;
}

/// Adds the part of the section between one, two or three places.
void add_piece(const Mesh& mesh, int element, double thickness, const std::vector<Barycentric>& ends,
               std::vector<Piece>& pieces) {
  const auto x = [&](std::size_t i) { return position(mesh, element, ends[i]); };
  double area = thickness;
  if (ends.size() == 2) area *= (x(1) - x(0)).norm();
  if (ends.size() == 3) area = 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  if (!(area > 0)) return;
  Barycentric middle{};
  for (const Barycentric& end : ends)
    for (std::size_t a = 0; a < 4; ++a) middle[a] += end[a] / static_cast<double>(ends.size());
  pieces.push_back({element, area, shape_weights(mesh.kinds[static_cast<std::size_t>(element)], middle)});
}

std::vector<Piece> cut(const Body& body, double thickness, const Plane& plane) {
  std::vector<Piece> pieces;
  for (const int element : body.elements) {
    const std::vector<Barycentric> ends = crossings(*body.mesh, element, plane);
    if (ends.empty()) continue;
    if (ends.size() <= 3) {
      add_piece(*body.mesh, element, thickness, ends, pieces);
      continue;
    }
    add_piece(*body.mesh, element, thickness, {ends[0], ends[1], ends[2]}, pieces);
    add_piece(*body.mesh, element, thickness, {ends[0], ends[2], ends[3]}, pieces);
  }
  return pieces;
}

/// An element with corners on both sides.
struct Bridge {
  int element;
  Vec3 slope;  ///< gradient of the function that is linear in the element, 1 at corners on the side of the normal, else
               ///< 0
};

std::vector<Bridge> bridges(const Body& body, const Plane& plane) {
  std::vector<Bridge> found;
  const Mesh& mesh = *body.mesh;
  const int dimension = msml::dimension(body.kind);
  for (const int element : body.elements) {
    const auto side = [&](int a) {
      return plane.distance(mesh.points.row(mesh.cell(element)[a]).transpose()) < 0 ? 0.0 : 1.0;
    };
    Mat3 edges = Mat3::Identity();
    Vec3 steps = Vec3::Zero();
    for (int a = 1; a <= dimension; ++a) {
      edges.row(a - 1) = mesh.points.row(mesh.cell(element)[a]) - mesh.points.row(mesh.cell(element)[0]);
      steps[a - 1] = side(a) - side(0);
    }
    if (steps.norm() > 0) found.push_back({element, edges.inverse() * steps});
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

class SectionWriter final : public TableWriter {
 public:
  SectionWriter(const Simulation& simulation, const OutputRequest& request, const std::filesystem::path& folder)
      : TableWriter(request, folder,
                    {"time", "area", "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"}),
        body_(simulation.body),
        normal_(request.normal.normalized()) {
    check(*request.record);
    const Plane plane{*request.point, normal_, 1e-10 * diagonal(*body_.mesh)};
    pieces_ = cut(body_, simulation.model.thickness, plane);
    bridges_ = bridges(body_, plane);
    if (pieces_.empty())
      refuse(*request.record, fmt::format("the plane through {} with the normal {} misses the body, which spans {}",
                                          place(*request.point), place(normal_), bounds(body_)));
  }

 private:
  void check(const Record& record) const {
    const int dimension = msml::dimension(body_.kind);
    if (dimension == 0) refuse(record, "particles have no sections");
    if (body_.scalar) refuse(record, "a scalar problem has no forces");
    if (normal_.tail(3 - dimension).norm() > 0)
      refuse(record, fmt::format("the normal {} leaves the {} of the body", place(normal_),
                                 dimension == 1 ? "line (along x)" : "plane (of x and y)"));
  }

  std::vector<std::vector<double>> rows(const fe::State& state, StateFields& fields) const override {
    const Points x = body_.small_strain ? body_.mesh->points : fields.positions();
    const fe::ElementResults results = fields.measure(needed);
    const auto [area, centroid] = deformed(results.deformation_gradient, x);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (const Bridge& bridge : bridges_) {
      const auto e = static_cast<std::size_t>(bridge.element);
      const Vec3 pull = results.volume[e] * (tensor(results.first_piola, e) * bridge.slope);
      force += pull;
      moment += (mean_over(*body_.mesh, bridge.element, x) - centroid).cross(pull);
      for (std::size_t j = 0; j < 3; ++j)
        moment +=
            Vec3::Unit(static_cast<Eigen::Index>(j)).cross(tensor(results.stress_moments, 3 * e + j) * bridge.slope);
    }
    return {{state.time, area, force[0], force[1], force[2], moment[0], moment[1], moment[2]}};
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

  const Body& body_;
  Vec3 normal_;
  std::vector<Piece> pieces_;
  std::vector<Bridge> bridges_;
};

}  // namespace

std::unique_ptr<OutputWriter> make_section(const Simulation& simulation, const OutputRequest& request,
                                           const std::filesystem::path& folder) {
  return std::make_unique<SectionWriter>(simulation, request, folder);
}

}  // namespace msml::simulation
