// SPDX-License-Identifier: GPL-3.0-or-later
// ComputeFieldError: how far a field of points is from a formula, or from the same field on another mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msml/core/formula.hpp"
#include "msml/core/operator.hpp"
#include "operators/compare_meshes.hpp"
#include "operators/early_checks.hpp"
#include "operators/vtk_sample.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::operators {

Operator simulate_field_error();

namespace {

using fe::Rule;
using fe::Simplex;
using Vector = Eigen::VectorXd;

/// The exact field: one function per component, at a time.
struct Exact {
  std::vector<Function> components;
  double time;
  Vector at(const Vec3& X) const {
    Vector value(static_cast<Eigen::Index>(components.size()));
    for (std::size_t c = 0; c < components.size(); ++c) value[static_cast<Eigen::Index>(c)] = components[c](X, time);
    return value;
  }
  /// Derivative along axis k by central differences of fourth order: error about 1e-11 of the field's size.
  Vector slope(const Vec3& X, int k, double length) const {
    const double h = 1e-3 * length;
    const auto shifted = [&](double s) { return at(X + s * h * Vec3::Unit(k)); };
    return (8 * (shifted(1) - shifted(-1)) - (shifted(2) - shifted(-2))) / (12 * h);
  }
};

/// Squares of the error and of the exact field, added up.
struct Sums {
  double error = 0, exact = 0;
};

struct Problem {
  const Mesh& mesh;
  const Points& X;  ///< reference positions
  const Field& field;
  const Exact& exact;
  bool slopes;    ///< of the gradients (H1 seminorm) instead of the values
  double length;  ///< of the body, for differences
  Vector value(int node) const {
    return Eigen::Map<const Vector>(field.values.data() + static_cast<std::size_t>(node * field.components),
                                    field.components);
  }
};

/// Adds the integral over one element.
template <int dimension, int nodes>
void add_element(const Problem& p, const int* ids, Sums& sums) {
  static const Rule<dimension> rule = fe::rule_of_size<dimension>(nodes > dimension + 1 ? 4 : 3);
  for (const auto& q : rule) {
    const auto J = fe::jacobian<dimension, nodes>(p.X, ids, q.xi);
    const Vec3 X = fe::place<dimension, nodes>(p.X, ids, q.xi);
    const double weight = q.weight * J.determinant();
    const auto add = [&](const Vector& found, const Vector& exact) {
      sums.error += weight * (found - exact).squaredNorm();
      sums.exact += weight * exact.squaredNorm();
    };
    if (p.slopes) {
      const auto inverse = J.inverse().eval();
      const auto g = Simplex<dimension, nodes>::gradients(q.xi);
      for (int k = 0; k < dimension; ++k) {
        Vector slope = Vector::Zero(p.field.components);
        for (std::size_t a = 0; a < nodes; ++a)
          for (int d = 0; d < dimension; ++d)
            slope += g[a][static_cast<std::size_t>(d)] * inverse(d, k) * p.value(ids[a]);
        add(slope, p.exact.slope(X, k, p.length));
      }
    } else {
      const auto N = Simplex<dimension, nodes>::values(q.xi);
      Vector value = Vector::Zero(p.field.components);
      for (std::size_t a = 0; a < nodes; ++a) value += N[a] * p.value(ids[a]);
      add(value, p.exact.at(X));
    }
  }
}

void add_cell(const Problem& p, CellKind kind, const int* ids, Sums& sums) {
  switch (kind) {
    case CellKind::vertex:
      return;
    case CellKind::line2:
      return add_element<1, 2>(p, ids, sums);
    case CellKind::line3:
      return add_element<1, 3>(p, ids, sums);
    case CellKind::tri3:
      return add_element<2, 3>(p, ids, sums);
    case CellKind::tri6:
      return add_element<2, 6>(p, ids, sums);
    case CellKind::tet4:
      return add_element<3, 4>(p, ids, sums);
    case CellKind::tet10:
      return add_element<3, 10>(p, ids, sums);
  }
}

Sums integrate(const Problem& p) {
  int highest = 0;
  for (const CellKind kind : p.mesh.kinds) highest = std::max(highest, dimension(kind));
  Sums sums;
  for (int c = 0; c < p.mesh.cell_count(); ++c) {
    const CellKind kind = p.mesh.kinds[static_cast<std::size_t>(c)];
    if (dimension(kind) == highest) add_cell(p, kind, p.mesh.cell(c), sums);
  }
  return sums;
}

/// At nodes: the mean of the squares, or the largest.
Sums at_nodes(const Problem& p, bool largest) {
  Sums sums;
  for (int n = 0; n < p.mesh.point_count(); ++n) {
    const Vector exact = p.exact.at(p.X.row(n).transpose());
    const double error = (p.value(n) - exact).squaredNorm(), size = exact.squaredNorm();
    sums.error = largest ? std::max(sums.error, error) : sums.error + error / p.mesh.point_count();
    sums.exact = largest ? std::max(sums.exact, size) : sums.exact + size / p.mesh.point_count();
  }
  return sums;
}

double finished(const Sums& sums, bool relative) {
  if (!relative) return std::sqrt(sums.error);
  if (!(sums.exact > 0))
    throw Error("the expected field is zero, so an error relative to it has no meaning: relative = false");
  return std::sqrt(sums.error / sums.exact);
}

const Field& field_of(const Mesh& mesh, const std::string& name) {
  std::vector<std::string> names;
  for (const Field& field : mesh.point_fields) {
    if (field.name == name) return field;
    names.push_back(field.name);
  }
  throw Error(fmt::format("field = '{}' is no point field of the mesh{}; it has {}", name, did_you_mean(name, names),
                          fmt::join(names, ", ")));
}

double against_formula(const Mesh& mesh, const std::string& name, const Exact& exact, const std::string& norm,
                       bool relative) {
  const Field& field = field_of(mesh, name);
  if (static_cast<int>(exact.components.size()) != field.components)
    throw Error(fmt::format("expected has {} components, but the field '{}' has {}", exact.components.size(), name,
                            field.components));
  const Points X = reference_points(mesh);
  const double length = (X.colwise().maxCoeff() - X.colwise().minCoeff()).norm();
  const Problem problem{mesh, X, field, exact, norm == "H1", length};
  const bool integral = norm == "L2" || norm == "H1";
  return finished(integral ? integrate(problem) : at_nodes(problem, norm == "maximum"), relative);
}

/// The field of a mesh at the nodes of another.
Field at_nodes_of(const Mesh& other, const Mesh& mesh, const Field& field) {
  const Sampler sampler(mesh, reference_points(mesh));
  const Points X = reference_points(other);
  Field found{.name = field.name, .components = field.components, .values = {}};
  for (int n = 0; n < other.point_count(); ++n) {
    const Place place = sampler.find(X.row(n).transpose());
    for (int c = 0; c < field.components; ++c) {
      double sum = 0;
      for (std::size_t a = 0; a < place.weights.size(); ++a)
        sum +=
            place.weights[a] * field.values[static_cast<std::size_t>(mesh.cell(place.cell)[a] * field.components + c)];
      found.values.push_back(sum);
    }
  }
  return found;
}

/// The gradient of the difference, both fields as the shape functions of the reference's elements see them.
double gradient_against_mesh(const Mesh& mesh, const Mesh& reference, const std::string& name, bool relative) {
  const Field &field = field_of(mesh, name), &exact = field_of(reference, name);
  if (field.components != exact.components)
    throw Error(fmt::format("field '{}' has different components on the two meshes", name));
  Field difference = at_nodes_of(reference, mesh, field);
  for (std::size_t k = 0; k < difference.values.size(); ++k) difference.values[k] -= exact.values[k];
  const Points X = reference_points(reference);
  const Exact zero{std::vector<Function>(static_cast<std::size_t>(field.components)), 0};
  const auto square = [&](const Field& of) { return integrate({reference, X, of, zero, true, 1}).error; };
  return finished({square(difference), square(exact)}, relative);
}

double against_mesh(const Mesh& mesh, const Mesh& reference, const std::string& name, const std::string& norm,
                    bool relative) {
  if (norm == "H1") return gradient_against_mesh(mesh, reference, name, relative);
  const Field& exact = field_of(reference, name);
  field_of(mesh, name);
  for (const FieldDifference& difference : compare(mesh, reference).fields) {
    if (difference.name != name || difference.on_cells) continue;
    const double error = norm == "L2" ? difference.l2 : norm == "RMS" ? difference.rms : difference.max;
    double size = norm == "L2" ? difference.reference_l2 : difference.reference_max;
    if (norm == "RMS")
      size = Eigen::Map<const Vector>(exact.values.data(), static_cast<Eigen::Index>(exact.values.size())).norm() /
             std::sqrt(static_cast<double>(reference.point_count()));
    return finished({error * error, size * size}, relative);
  }
  throw Error(fmt::format("field '{}' has different components on the two meshes", name));
}

}  // namespace

Operator simulate_field_error() {
  Operator op("ComputeFieldError", "Error of a point field against a formula, or against the field on a finer mesh.");
  op.source("L2 and H1 by Gauss rules of degree 5 (linear) and 7 (quadratic elements)");
  op.reports();
  op.note("Positions are those of the reference configuration: a field 'displacement' is taken off the points.");
  const auto mesh = op.input<Mesh>("mesh", "with the field; of a series the last state");
  const auto reference = op.input<Mesh>("referenceMesh", "whose field is taken as true; instead of expected", true);
  const auto field = op.parameter<std::string>("field", {.fallback = "displacement", .doc = "name of the point field"});
  const auto expected = op.parameter<Formulas>(
      "expected", {.optional = true, .doc = "the exact field, one formula in X, Y, Z and t for each component"});
  const auto time = op.parameter("time", {.unit = "time", .fallback = 0.0, .doc = "value of t in expected"});
  const auto norm = op.parameter<std::string>(
      "norm",
      {.fallback = "L2",
       .choices = {"L2", "H1", "RMS", "maximum"},
       .doc = "L2 and H1 (of the gradient) integrate over the body, with referenceMesh over its elements; RMS and "
              "maximum are of the nodes, with referenceMesh those of that mesh"});
  const auto relative =
      op.parameter<bool>("relative", {.fallback = true, .doc = "divide by the same norm of the exact field"});
  const auto error = op.output<double>("error", "0 = equal");
  const auto check = [=](const Record& r) {
    if (r.is_given(reference) == r.is_given(expected))
      throw Error("give either expected or referenceMesh, what the field is to be compared with");
    if (r.has(expected) && functions(r, expected).empty())
      throw Error("expected is empty; one formula for each component of the field is needed");
  };
  run_checked(op, check, [=](Context& c) {
    const Record& args = c.args();
    const auto measured = [&] {
      if (args.has(reference))
        return against_mesh(c.get(mesh), c.get(reference), c.get(field), c.get(norm), c.get(relative));
      const Exact exact{functions(args, expected), c.get(time)};
      return against_formula(c.get(mesh), c.get(field), exact, c.get(norm), c.get(relative));
    };
    const double found = measured();
    c.reporter().print(fmt::format("{}error of {} ({}): {:.6g}", c.get(relative) ? "relative " : "", c.get(field),
                                   c.get(norm), found));
    c.set(error, found);
  });
  return op;
}

}  // namespace msml::operators
