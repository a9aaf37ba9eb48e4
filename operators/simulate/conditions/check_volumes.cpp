// SPDX-License-Identifier: GPL-3.0-or-later
// Initial motions of bodies that keep their volume, as far as expressions alone decide.
#include <Eigen/LU>
#include <cmath>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

constexpr double clearly = 1e-3;  // of the gradient: more than rounded numbers make; what is less is left to the run
constexpr double scales[] = {0.01, 1, 100};  // of the places, in whatever unit bodies have
constexpr int places_per_scale = 17, fewest_places = 10;

/// Numbers between -1 and 1 that fill space evenly: multiples of irrational numbers, without their integers.
Vec3 place_of(int k) {
  Vec3 X;
  for (int axis = 0; axis < 3; ++axis) {
    const double turns = (k + 1) * std::sqrt(axis == 2 ? 5.0 : 2.0 + axis);
    X[axis] = 2 * (turns - std::floor(turns)) - 1;
  }
  return X;
}

/// Derivatives by central differences of fourth order.
Mat3 gradient(const fe::VectorFunction& field, const Vec3& X, double h) {
  Mat3 found;
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = h * Vec3::Unit(k);
    found.col(k) =
        (8 * (field(X + step, 0) - field(X - step, 0)) - (field(X + 2 * step, 0) - field(X - 2 * step, 0))) / (12 * h);
  }
  return found;
}

/// How much a motion changes volumes at a place: its divergence, or det F - 1, and the gradient that this belongs to.
struct Change {
  double value = 0, gradient = 0;
};

Change change_of(const Mat3& H, bool velocity) {
  return {velocity ? H.trace() : (Mat3::Identity() + H).determinant() - 1, H.norm()};
}

/// The change at a place; nothing where it is none, or hardly more than round-off and the shortness of differences.
std::optional<Change> clear_change(const fe::VectorFunction& field, bool velocity, const Vec3& X, double h) {
  const Change fine = change_of(gradient(field, X, h), velocity);
  const Change coarse = change_of(gradient(field, X, 2 * h), velocity);
  const double unsure = 10 * std::abs(fine.value - coarse.value);
  if (!(std::abs(fine.value) > clearly * fine.gradient + unsure)) return std::nullopt;
  return fine;
}

/// A place where the field changes volumes, if it does so at all that are looked at and that it is defined at.
std::optional<std::pair<Vec3, Change>> changes_everywhere(const fe::VectorFunction& field, bool velocity) {
  std::optional<std::pair<Vec3, Change>> found;
  int defined = 0;
  for (const double scale : scales)
    for (int k = 0; k < places_per_scale; ++k) {
      const Vec3 X = scale * place_of(k);
      std::optional<Change> change;
      try {
        change = clear_change(field, velocity, X, 1e-3 * scale);
      } catch (const Error&) {
        continue;  // not finite there, where the body may not be
      }
      if (!change) return std::nullopt;
      if (++defined == 1 || (scale == 1 && k == 0)) found = {X, *change};
    }
  return defined < fewest_places ? std::nullopt : found;
}

}  // namespace

void check_volumes(const Record& condition, const Surroundings& around, bool alone) {
  const bool velocity = condition.tag() == "initialVelocity";
  if ((!velocity && condition.tag() != "initialDisplacement") || !around.incompressible || !alone) return;
  // Statics take a displacement for a first guess alone.
  if (around.settings == nullptr || !fe::is_dynamic(around.settings->integrator)) return;
  // Of several regions the nodes may be those of another one.
  if (condition.given[static_cast<std::size_t>(condition.description->find("indices"))] && !around.one_region) return;
  const Key<Formulas> key{condition.description->find(velocity ? "velocity" : "displacement")};
  if (!condition.has(key) || condition[key].size() != 3) return;
  const auto found = changes_everywhere(vector_of(functions(condition, key)), velocity);
  if (!found) return;
  const auto& [X, change] = *found;
  const std::string where =
      fmt::format(" at ({:.3g} {:.3g} {:.3g}), and not 0 at any other place that was looked at", X[0], X[1], X[2]);
  if (velocity)
    refuse(condition,
           fmt::format("velocity has the divergence {:.3g}{}: it changes volumes, which incompressible=\"true\" "
                       "forbids; take one whose divergence is 0, such as a rotation, or a finite bulkModulus",
                       change.value, where));
  refuse(
      condition,
      fmt::format("displacement has det F - 1 = {:.3g}{}: it changes volumes, which incompressible=\"true\" forbids; "
                  "take one whose det F is 1, such as a shear or a twist, or a finite bulkModulus",
                  change.value, where));
}

}  // namespace msml::simulation
