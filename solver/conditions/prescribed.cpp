// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the prescribed displacements of a step.
#include "solver/conditions/prescribed.hpp"

namespace msml::fe {

Vector Supports::at(double share, double /*time*/) const {
  Vector value = Vector::Zero(start.size());
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (fixed[k]) value[i] = ramped[k] ? start[i] + share * (end[i] - start[i]) : end[i];
  }
  return value;
}

Supports make_supports(const Step& step, const Numbering& numbering, const Vector& u) {
  const std::size_t size = static_cast<std::size_t>(3 * numbering.nodes());
  Supports supports{Mask(size, 0), u, u, Mask(size, 0)};
  for (const Prescribed& condition : step.prescribed)
    for (std::size_t i = 0; i < condition.nodes.size(); ++i) {
      const int node = numbering.number_of[static_cast<std::size_t>(condition.nodes[i])];
      if (node < 0) continue;
      const Vec3& value = condition.values.size() == 1 ? condition.values.front() : condition.values[i];
      for (int c = 0; c < 3; ++c) {
        if (!condition.components[c]) continue;
        const std::size_t k = static_cast<std::size_t>(3 * node + c);
        supports.fixed[k] = 1;
        supports.end[3 * node + c] = value[c];
        supports.ramped[k] = condition.ramp == Ramp::linear;
      }
    }
  for (int node = 0; node < numbering.nodes(); ++node)
    for (int c = numbering.components; c < 3; ++c) {
      const std::size_t k = static_cast<std::size_t>(3 * node + c);
      supports.fixed[k] = 1;
      supports.start[3 * node + c] = supports.end[3 * node + c] = 0;
      supports.ramped[k] = 0;
    }
  return supports;
}

}  // namespace msml::fe
