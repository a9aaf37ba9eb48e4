// SPDX-License-Identifier: GPL-3.0-or-later
// Differences between the fields of two meshes.
#include "operators/compare_meshes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>

#include "msml/core/error.hpp"
#include "operators/vtk_sample.hpp"

namespace msml::operators {
namespace {

using Simplex = std::array<int, 4>;  ///< node ids, the first dimension + 1 of them

/// The linear simplices that a cell is cut into: itself, or at its mid nodes. The octahedron left in the middle of a
/// tet10 is cut along the diagonal 4-9.
std::vector<Simplex> simplices(CellKind kind) {
  switch (kind) {
    case CellKind::vertex:
      return {};
    case CellKind::line2:
      return {{0, 1}};
    case CellKind::line3:
      return {{0, 2}, {2, 1}};
    case CellKind::tri3:
      return {{0, 1, 2}};
    case CellKind::tri6:
      return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    case CellKind::tet4:
      return {{0, 1, 2, 3}};
    case CellKind::tet10:
      return {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3},
              {4, 9, 5, 6}, {4, 9, 6, 7}, {4, 9, 7, 8}, {4, 9, 8, 5}};
  }
  return {};
}

/// Length, area or volume.
double measure(const Points& points, const Simplex& s, int dimension) {
  const Vec3 a = points.row(s[1]) - points.row(s[0]);
  if (dimension == 1) return a.norm();
  const Vec3 b = points.row(s[2]) - points.row(s[0]);
  if (dimension == 2) return a.cross(b).norm() / 2;
  const Vec3 c = points.row(s[3]) - points.row(s[0]);
  return std::abs(a.cross(b).dot(c)) / 6;
}

/// The simplices of all cells of highest dimension, and the cell that each comes from.
struct Parts {
  int dimension = 0;
  std::vector<Simplex> simplices;
  std::vector<double> measures;
  std::vector<int> cells;
};

Parts parts_of(const Mesh& mesh, const Points& points) {
  Parts parts;
  for (const CellKind kind : mesh.kinds) parts.dimension = std::max(parts.dimension, dimension(kind));
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    if (dimension(kind) != parts.dimension) continue;
    for (Simplex s : simplices(kind)) {
      for (int k = 0; k <= parts.dimension; ++k)
        s[static_cast<std::size_t>(k)] = mesh.cell(c)[s[static_cast<std::size_t>(k)]];
      parts.simplices.push_back(s);
      parts.measures.push_back(measure(points, s, parts.dimension));
      parts.cells.push_back(c);
    }
  }
  return parts;
}

/// sqrt of the integral of the squared values; for a linear function on a simplex of dimension n and measure V that is
/// V (|sum of d_i|^2 + sum of |d_i|^2) / ((n + 1) (n + 2)), from the mass matrix V (1 + delta_ij) / ((n + 1) (n + 2)).
double l2_norm(const Parts& parts, const Field& field, bool on_cells) {
  const Eigen::Map<const Eigen::MatrixXd> d(field.values.data(), field.components,
                                            static_cast<Eigen::Index>(field.values.size()) / field.components);
  const int n = parts.dimension;
  double sum = 0;
  for (std::size_t s = 0; s < parts.simplices.size(); ++s) {
    if (on_cells) {
      sum += parts.measures[s] * d.col(parts.cells[s]).squaredNorm();
      continue;
    }
    Eigen::VectorXd total = Eigen::VectorXd::Zero(field.components);
    double squares = 0;
    for (int k = 0; k <= n; ++k) {
      const auto value = d.col(parts.simplices[s][static_cast<std::size_t>(k)]);
      total += value;
      squares += value.squaredNorm();
    }
    sum += parts.measures[s] * (total.squaredNorm() + squares) / ((n + 1) * (n + 2));
  }
  return std::sqrt(sum);
}

const Field* partner(const std::vector<Field>& fields, const Field& wanted) {
  for (const Field& field : fields)
    if (field.name == wanted.name && field.components == wanted.components) return &field;
  return nullptr;
}

/// Cell fields with the region ids as one more.
std::vector<Field> cell_fields_of(const Mesh& mesh) {
  std::vector<Field> fields = mesh.cell_fields;
  if (!mesh.regions.empty()) fields.push_back({.name = "region", .values = {mesh.regions.begin(), mesh.regions.end()}});
  return fields;
}

bool match(const Mesh& a, const Mesh& b, const Points& at_a, const Points& at_b) {
  if (a.kinds != b.kinds || a.nodes != b.nodes || at_a.rows() != at_b.rows()) return false;
  constexpr double tolerance = 1e-6;  // files in single precision still match
  const double diagonal = (at_b.colwise().maxCoeff() - at_b.colwise().minCoeff()).norm();
  return (at_a - at_b).rowwise().norm().maxCoeff() <= tolerance * diagonal;
}

Points centres(const Mesh& mesh, const Points& points) {
  Points result = Points::Zero(mesh.cell_count(), 3);
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(c)]);
    for (int k = 0; k < corners; ++k) result.row(c) += points.row(mesh.cell(c)[k]) / corners;
  }
  return result;
}

/// A's fields at given points.
class Interpolation {
 public:
  Interpolation(const Mesh& mesh, const Points& points, const Points& at) : mesh_(mesh) {
    const Sampler sampler(mesh, points);
    for (Eigen::Index i = 0; i < at.rows(); ++i) places_.push_back(sampler.find(at.row(i)));
  }
  const std::vector<Place>& places() const { return places_; }

  Field operator()(const Field& field, bool on_cells) const {
    Field result{.name = field.name, .components = field.components, .values = {}};
    const auto n = static_cast<std::size_t>(field.components);
    result.values.assign(places_.size() * n, 0);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      for (std::size_t k = 0; k < (on_cells ? 1 : place.weights.size()); ++k) {
        const auto from = static_cast<std::size_t>(on_cells ? place.cell : mesh_.cell(place.cell)[k]);
        const double weight = on_cells ? 1 : place.weights[k];
        for (std::size_t c = 0; c < n; ++c) result.values[i * n + c] += weight * field.values[from * n + c];
      }
    }
    return result;
  }

 private:
  const Mesh& mesh_;
  std::vector<Place> places_;
};

FieldDifference difference(const Field& a, const Field& b, bool on_cells, const Parts& parts, const Points& at) {
  FieldDifference d{.name = b.name, .on_cells = on_cells, .components = b.components};
  d.count = static_cast<std::size_t>(at.rows());
  Field delta = b;
  for (std::size_t i = 0; i < delta.values.size(); ++i) delta.values[i] = a.values[i] - b.values[i];
  const auto length = [&](const Field& f, std::size_t i) {
    return Eigen::Map<const Eigen::VectorXd>(f.values.data() + i * static_cast<std::size_t>(f.components), f.components)
        .norm();
  };
  double squares = 0;
  for (std::size_t i = 0; i < d.count; ++i) {
    const double size = length(delta, i);
    squares += size * size;
    d.reference_max = std::max(d.reference_max, length(b, i));
    if (d.where_id >= 0 && size <= d.max) continue;
    d.max = size;
    d.where_id = static_cast<int>(i);
    d.where = at.row(static_cast<Eigen::Index>(i));
  }
  d.rms = d.count > 0 ? std::sqrt(squares / static_cast<double>(d.count)) : 0;
  d.l2 = l2_norm(parts, delta, on_cells);
  d.reference_l2 = l2_norm(parts, b, on_cells);
  return d;
}

using AtB = std::function<Field(const Field& of_a)>;

void compare_fields(const std::vector<Field>& a, const std::vector<Field>& b, bool on_cells, const AtB& at_b,
                    const Parts& parts, const Points& at, Comparison& result) {
  for (const Field& field : b) {
    if (const Field* const other = partner(a, field))
      result.fields.push_back(difference(at_b(*other), field, on_cells, parts, at));
    else
      result.only_in_b.push_back(field.name);
  }
  for (const Field& field : a)
    if (partner(b, field) == nullptr) result.only_in_a.push_back(field.name);
}

}  // namespace

double Comparison::max() const {
  double largest = 0;
  for (const FieldDifference& field : fields) largest = std::max(largest, field.max);
  return largest;
}

Points reference_points(const Mesh& mesh) {
  Points points = mesh.points;
  for (const Field& field : mesh.point_fields)
    if (field.name == "displacement" && field.components == 3)
      points -= Eigen::Map<const Points>(field.values.data(), points.rows(), 3);
  return points;
}

Comparison compare(const Mesh& a, const Mesh& b) {
  a.check();
  b.check();
  if (b.point_count() == 0) throw Error("the reference mesh has no points");
  const Points at_a = reference_points(a), at_b = reference_points(b), middles = centres(b, at_b);
  const Parts parts = parts_of(b, at_b);
  Comparison result;
  result.by_node = match(a, b, at_a, at_b);
  const std::vector<Field> cells_a = cell_fields_of(a), cells_b = cell_fields_of(b);
  if (result.by_node) {
    const AtB same = [](const Field& field) { return field; };
    compare_fields(a.point_fields, b.point_fields, false, same, parts, at_b, result);
    compare_fields(cells_a, cells_b, true, same, parts, middles, result);
    return result;
  }
  const Interpolation nodes(a, at_a, at_b);
  for (const Place& place : nodes.places()) {
    result.outside += place.distance > 0;
    result.outside_distance = std::max(result.outside_distance, place.distance);
  }
  compare_fields(
      a.point_fields, b.point_fields, false, [&](const Field& f) { return nodes(f, false); }, parts, at_b, result);
  const Interpolation cells(a, at_a, middles);
  compare_fields(
      cells_a, cells_b, true, [&](const Field& f) { return cells(f, true); }, parts, middles, result);
  return result;
}

}  // namespace msml::operators
