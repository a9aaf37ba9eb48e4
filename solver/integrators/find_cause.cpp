// SPDX-License-Identifier: GPL-3.0-or-later
// Looks behind an iteration that led nowhere: what is it about the body that it could not get past?
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/integrators/stepper.hpp"

namespace msml::fe {
namespace {

/// The tangent of one state.
struct Tangent {
  /// Positive definite; of mixed elements: one negative pivot for each pressure; under follower pressure: a determinant
  /// of the sign at rest.
  bool stable = false;
  double lowest = 0;  ///< eigenvalue of K x = m D x nearest to zero, D the diagonal of K; 0 if not found
};

Vector diagonal_of(const BlockMatrix& K) {
  Vector d(3 * K.pattern->nodes());
  for (Eigen::Index k = 0; k < d.size(); ++k) {
    const auto place = static_cast<std::size_t>(K.pattern->diagonal[static_cast<std::size_t>(k / 3)]);
    d[k] = K.values[9 * place + 4 * static_cast<std::size_t>(k % 3)];
  }
  return d;
}

/// By inverse iteration, to a few per cent.
double lowest_eigenvalue(LinearSystem& linear, const BlockMatrix& K, const Mask& fixed) {
  const Vector D = diagonal_of(K);
  Vector x(D.size()), y;
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x[k] = fixed[static_cast<std::size_t>(k)] ? 0 : std::sin(1 + 2.4 * static_cast<double>(k));  // of no symmetry
  double value = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double size = std::sqrt(std::abs(x.dot(D.cwiseProduct(x))));
    if (!(size > 0) || !std::isfinite(size)) return 0;
    const Vector right = D.cwiseProduct(x) / size;
    if (linear.solve(right, 1e-6, y) != LinearStatus::done) return 0;
    const double before = value, inverse = y.dot(right);
    value = inverse != 0 ? 1 / inverse : 0;
    x = y;
    if (std::abs(value - before) <= 0.02 * std::abs(value)) break;
  }
  return std::isfinite(value) ? value : 0;
}

Tangent look_at(Run& run, const EquilibriumPath& path, const Vector& u, double share, bool eigenvalue) {
  run.newton.prepare(u, path.loads(share));
  BlockMatrix K = run.newton.tangent();
  const BlockMatrix* followers = run.newton.followers();
  if (followers) add(K, 1, *followers);
  path.supports.slides.project(K);
  const auto own = followers ? make_unsymmetric(run.model.settings.threads) : nullptr;
  LinearSystem& linear = own ? *own : run.newton.linear();
  LinearStatus status = linear.factor(K, path.supports.fixed);
  if (status == LinearStatus::done) status = linear.probe();
  const auto pressures = static_cast<long>(run.equations.numbering().pressure_of.size());
  const bool turned =
      followers ? linear.negative_determinant() != (pressures % 2 != 0) : linear.negative_pivots() != pressures;
  Tangent found;
  found.stable = status == LinearStatus::done && !turned;
  if (found.stable && eigenvalue) found.lowest = lowest_eigenvalue(linear, K, path.supports.fixed);
  return found;
}

struct Flattest {
  int element = -1;
  double shape = 1;
};

/// Among the tetrahedra at a mesh point the one whose volume is smallest beside that of a regular one on its longest
/// edge, a^3 / (6 sqrt 2), at rest.
Flattest flattest_at(const Mesh& mesh, int point) {
  Flattest found;
  for (int e = 0; e < mesh.cell_count() && point >= 0; ++e) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(e)];
    const int* ids = mesh.cell(e);
    if (dimension(kind) != 3 || std::find(ids, ids + node_count(kind), point) == ids + node_count(kind)) continue;
    double longest = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b)
        longest = std::max(longest, (mesh.points.row(ids[a]) - mesh.points.row(ids[b])).norm());
    Mat3 J;
    for (int a = 0; a < 3; ++a) J.row(a) = mesh.points.row(ids[a + 1]) - mesh.points.row(ids[0]);
    const double shape = std::numbers::sqrt2 * J.determinant() / (longest * longest * longest);
    if (shape < found.shape) found = {e, shape};
  }
  return found;
}
/// A stiffness that has fallen to this share of that at rest, with an indefinite one next to it, is on its way to zero;
/// below the second it is nearly there.
constexpr double soft = 0.3, vanishing = 0.1;
constexpr double flat = 1e-6;        ///< an element of this share of its volume is crushed to nothing
constexpr double flat_shape = 1e-3;  ///< an element of this shape is bad, see flattest_at

}  // namespace

std::string cause_of_iterations(const Run& run, IncrementResult& result) {
  const auto iterations = static_cast<int>(result.residuals.size()) - 1;
  if (const auto [element, shape] = flattest_at(*run.model.mesh, result.worst_node); shape < flat_shape) {
    result.stop = Stop::bad_element;
    return fmt::format(
        "what is left is largest at element {}, which is nearly flat: its volume is {:.2g} of that of a "
        "regular tetrahedron on its longest edge",
        element, shape);
  }
  if (result.walked > 0) {
    result.stop = Stop::step_too_large;
    return fmt::format("of what changes at once in this step, the first {:.2g} is solved", result.walked);
  }
  if (iterations < 1 || 2 * std::max(result.definite, result.stunted) < iterations) return "";
  result.stop = Stop::indefinite_tangent;
  if (result.definite >= result.stunted)
    return fmt::format("{} of {} iterations met an indefinite tangent", result.definite, iterations);
  return fmt::format(
      "{} of {} iterations lessened the residual by less than an eighth of Newton's step: it has a "
      "minimum there that is no equilibrium, where the tangent is singular",
      result.stunted, iterations);
}

std::string find_cause(Run& run, const EquilibriumPath& path, double share, IncrementResult& result) {
  if (run.equations.small_strain() || run.equations.numbering().scalar || !result.u.allFinite()) return "";
  if (result.worst_J <= flat && !run.model.settings.allow_inverted) {
    result.stop = Stop::inverted_element;
    return "the iteration only goes on through an element crushed flat or turned inside out";
  }
  if (!run.free.modes.empty()) return "";
  const bool indefinite = !look_at(run, path, result.u, share, false).stable;
  const Tangent good = look_at(run, path, run.now.u, run.now.load_factor, true);
  const Tangent rest = look_at(run, path, Vector::Zero(run.now.u.size()), run.now.load_factor, true);
  run.newton.forget();
  if (!good.stable || !rest.stable || !(good.lowest < (indefinite ? soft : vanishing) * rest.lowest)) return "";
  result.stop = Stop::indefinite_tangent;
  return fmt::format(
      "at the last equilibrium, at {:.6g} of the loads, the softest motion has {:.2g} of the stiffness it has at rest, "
      "and no equilibrium is found beyond: the loads pass a limit point, or the body buckles there",
      run.now.load_factor, good.lowest / rest.lowest);
}

}  // namespace msml::fe
