// SPDX-License-Identifier: GPL-3.0-or-later
// Initial velocities of bodies that keep their volume.
#include <cmath>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

/// The gradient of an affine field; nothing if the field is not affine.
std::optional<Mat3> gradient_of(const std::vector<Function>& field) {
  const fe::VectorFunction v = vector_of(field);
  const Vec3 start = v(Vec3::Zero(), 0);
  Mat3 gradient;
  for (int k = 0; k < 3; ++k) gradient.col(k) = v(Vec3::Unit(k), 0) - start;
  const double scale = 1e-9 * (gradient.norm() + start.norm());  // round-off of expressions of that size
  for (const Vec3& X : {Vec3(0.3, 0.7, 0.2), Vec3(-2, 5, 11), Vec3(17, -3, -8)})
    if (!((v(X, 0) - start - gradient * X).norm() <= scale * (1 + X.norm()))) return std::nullopt;
  return gradient;
}

}  // namespace

void check_divergence(const Record& condition, const Surroundings& around, bool alone) {
  if (condition.tag() != "initialVelocity" || !around.incompressible || !alone) return;
  const Key<Formulas> velocity{condition.description->find("velocity")};
  if (condition.given[static_cast<std::size_t>(condition.description->find("indices"))] || !condition.has(velocity) ||
      condition[velocity].size() != 3)
    return;
  std::optional<Mat3> gradient;
  try {
    gradient = gradient_of(functions(condition, velocity));
  } catch (const Error&) {
    return;  // not finite at one of these places, which the body may not have
  }
  if (gradient && std::abs(gradient->trace()) > 1e-9 * gradient->norm())
    refuse(condition,
           fmt::format("velocity has the divergence {:g}: it changes volumes, which incompressible=\"true\" forbids; "
                       "take one whose divergence is 0, such as a rotation, or a finite bulkModulus",
                       gradient->trace()));
}

}  // namespace msml::simulation
