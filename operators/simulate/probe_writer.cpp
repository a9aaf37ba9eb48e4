// SPDX-License-Identifier: GPL-3.0-or-later
// A field at a place or at nodes over time.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/selection.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::simulation {
namespace {

/// A place in an element: weights of its nodes.
struct Spot {
  int element = -1;
  std::vector<double> weights;
  double outside = 0;  ///< largest negative barycentric coordinate, as a positive number; 0 inside
};

/// Reference coordinates of a place, by Newton's method: one iteration where edges are straight.
template <int dimension, int nodes>
Spot spot_in(const Mesh& mesh, int element, const Vec3& x) {
  using Element = fe::Simplex<dimension, nodes>;
  const int* ids = mesh.cell(element);
  std::array<double, dimension> xi;
  xi.fill(1.0 / (dimension + 1));
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Vec3 miss = x - fe::place<dimension, nodes>(mesh.points, ids, xi);
    const Eigen::Matrix<double, dimension, 1> step =
        fe::jacobian<dimension, nodes>(mesh.points, ids, xi).inverse() * miss.template head<dimension>();
    if (!step.allFinite()) return {.element = element, .weights = {}, .outside = 1e300};
    for (int d = 0; d < dimension; ++d) xi[static_cast<std::size_t>(d)] += step[d];
    if (step.norm() < 1e-13) break;
  }
  const auto N = Element::values(xi);
  const auto L = Element::barycentric(xi);
  return {element, {N.begin(), N.end()}, std::max(0.0, -*std::min_element(L.begin(), L.end()))};
}

Spot spot_of(const Mesh& mesh, CellKind kind, int element, const Vec3& x) {
  switch (kind) {
    case CellKind::line2:
      return spot_in<1, 2>(mesh, element, x);
    case CellKind::line3:
      return spot_in<1, 3>(mesh, element, x);
    case CellKind::tri3:
      return spot_in<2, 3>(mesh, element, x);
    case CellKind::tri6:
      return spot_in<2, 6>(mesh, element, x);
    case CellKind::tet4:
      return spot_in<3, 4>(mesh, element, x);
    default:
      return spot_in<3, 10>(mesh, element, x);
  }
}

double squared(double x) { return x * x; }

/// Distance of a place from a triangle (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_edge = [&](const Vec3& s, const Vec3& e) {
    const double length = (e - s).squaredNorm();
    const double at = length > 0 ? std::clamp((p - s).dot(e - s) / length, 0.0, 1.0) : 0.0;
    return (p - s - at * (e - s)).norm();
  };
  Eigen::Matrix<double, 3, 2> edges;
  edges << b - a, c - a;
  const Eigen::Matrix2d gram = edges.transpose() * edges;
  if (gram.determinant() > 1e-24 * squared(gram.trace())) {
    const Eigen::Vector2d at = gram.inverse() * (edges.transpose() * (p - a));
    if (at[0] >= 0 && at[1] >= 0 && at.sum() <= 1) return (p - a - edges * at).norm();
  }
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// From the surface of a solid body, or from the nodes of another.
double distance_to(const Body& body, const Vec3& x) {
  double least = std::numeric_limits<double>::infinity();
  if (dimension(body.kind) < 3) {
    for (int n = 0; n < body.mesh->point_count(); ++n)
      if (body.solid[static_cast<std::size_t>(n)])
        least = std::min(least, (body.mesh->points.row(n).transpose() - x).norm());
    return least;
  }
  const FaceTable table(body);
  for (const fe::Face& face : table.boundary_faces()) {
    const std::vector<int> n = face_nodes(*body.mesh, face);
    const auto at = [&](std::size_t i) -> Vec3 { return body.mesh->points.row(n[i]).transpose(); };
    least = std::min(least, distance(x, at(0), at(1), at(2)));
  }
  return least;
}

/// The element that holds a place of the reference configuration. Throws Error outside the body.
Spot find_spot(const Record& record, const Body& body, const Vec3& x) {
  if (body.kind == CellKind::vertex) refuse(record, "particles have no inside: take indices instead of a point");
  Spot best{.element = -1, .weights = {}, .outside = std::numeric_limits<double>::infinity()};
  for (const int element : body.elements) {
    Spot spot = spot_of(*body.mesh, body.kind, element, x);
    if (spot.outside < best.outside) best = std::move(spot);
    if (best.outside == 0) break;
  }
  if (best.outside > 1e-8)
    refuse(record, fmt::format("point {} is {:.3g} outside the body, which spans {}", place(x), distance_to(body, x),
                               bounds(body)));
  return best;
}

class ProbeWriter final : public OutputWriter {
 public:
  ProbeWriter(const Simulation& simulation, const OutputRequest& request, Reporter& reporter,
              const std::filesystem::path& folder)
      : mesh_(*simulation.body.mesh), every_(request.every), facts_(facts_of(request.fields.front())) {
    const Record& record = *request.record;
    if (request.point) {
      Spot spot = find_spot(record, simulation.body, *request.point);
      element_ = spot.element;
      weights_ = std::move(spot.weights);
    } else {
      if (!facts_.nodal)
        refuse(record, fmt::format("field {} is given at elements; a probe at nodes takes {}_nodal, one at a point "
                                   "both",
                                   facts_.name, facts_.name));
      nodes_ = select_nodes(record, simulation.body, reporter).nodes;
    }
    file_.emplace(folder / (request.id + ".csv"), columns());
  }

  bool wants(const fe::State& state) const override { return state.increment % every_ == 0; }

  void write(const fe::State& state, StateFields& fields) override {
    const Field field = fields.field(facts_.name);
    const auto width = static_cast<std::size_t>(field.components);
    std::vector<double> row{state.time};
    if (element_ < 0)
      for (const int node : nodes_) append(field, static_cast<std::size_t>(node), row);
    else if (!facts_.nodal)
      append(field, static_cast<std::size_t>(element_), row);
    else
      for (std::size_t c = 0; c < width; ++c) row.push_back(interpolated(field, c));
    file_->add(row);
    last_ = state.increment;
    file_->save(false);
  }

  void finish(const fe::State& last, StateFields& fields) override {
    if (last_ != last.increment) write(last, fields);
    file_->save(true);
  }

  Value value() const override { return File{file_->path()}; }

 private:
  std::vector<std::string> columns() const {
    std::vector<std::string> names{"time"};
    const auto group = [&](const std::string& tail) {
      for (const std::string& component : component_names(facts_))
        names.push_back(facts_.name + (component.empty() ? "" : "_" + component) + tail);
    };
    if (element_ >= 0) group("");
    for (const int node : nodes_) group(nodes_.size() > 1 ? fmt::format("@{}", node) : "");
    return names;
  }

  static void append(const Field& field, std::size_t row, std::vector<double>& out) {
    const auto width = static_cast<std::size_t>(field.components);
    for (std::size_t c = 0; c < width; ++c) out.push_back(field.values[row * width + c]);
  }

  double interpolated(const Field& field, std::size_t component) const {
    const auto width = static_cast<std::size_t>(field.components);
    double sum = 0;
    for (std::size_t a = 0; a < weights_.size(); ++a)
      sum += weights_[a] * field.values[static_cast<std::size_t>(mesh_.cell(element_)[a]) * width + component];
    return sum;
  }

  const Mesh& mesh_;
  int every_, last_ = -1, element_ = -1;
  std::vector<double> weights_;
  std::vector<int> nodes_;
  FieldFacts facts_;
  std::optional<CsvFile> file_;
};

}  // namespace

std::unique_ptr<OutputWriter> make_probe(const Simulation& simulation, const OutputRequest& request, Reporter& reporter,
                                         const std::filesystem::path& folder) {
  return std::make_unique<ProbeWriter>(simulation, request, reporter, folder);
}

}  // namespace msml::simulation
