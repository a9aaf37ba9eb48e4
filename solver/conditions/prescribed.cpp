// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the prescribed displacements of a step.
#include "solver/conditions/prescribed.hpp"

namespace msml::fe {

Vec3 MovedNode::at(double time) const {
  const Vec3 now = function ? function(X, time) : value;
  return factor ? Vec3(factor(time) * now) : now;
}

Vector Supports::at(double share, double time) const {
  Vector value = Vector::Zero(start.size());
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (fixed[k]) value[i] = ramped[k] ? start[i] + share * (end[i] - start[i]) : end[i];
  }
  for (std::size_t m = 0; m < moved.size(); ++m) {
    const Vec3 now = moved[m].at(time);
    for (int c = 0; c < 3; ++c)
      if (moved_by[static_cast<std::size_t>(3 * moved[m].node + c)] == static_cast<int>(m))
        value[3 * moved[m].node + c] = now[c];
  }
  return value;
}

namespace {

/// The entries of the moved unknowns become those of `value` of their nodes.
template <class Value>
void put(const Supports& supports, const Value& value, Vector& values) {
  for (std::size_t m = 0; m < supports.moved.size(); ++m) {
    const Vec3 found = value(supports.moved[m]);
    for (int c = 0; c < 3; ++c) {
      const int k = 3 * supports.moved[m].node + c;
      if (supports.moved_by[static_cast<std::size_t>(k)] == static_cast<int>(m)) values[k] = found[c];
    }
  }
}

}  // namespace

void Supports::set_off(double time, double dt, Vector& velocity) const {
  const double h = 0.1 * dt;
  const auto rate = [&](const MovedNode& node) -> Vec3 {
    return (4 * node.at(time + h) - 3 * node.at(time) - node.at(time + 2 * h)) / (2 * h);
  };
  put(*this, rate, velocity);
}

void Supports::set_off_rates(double time, double dt, Vector& acceleration) const {
  const double h = 0.1 * dt;
  const auto rate = [&](const MovedNode& node) -> Vec3 {
    return (2 * node.at(time) - 5 * node.at(time + h) + 4 * node.at(time + 2 * h) - node.at(time + 3 * h)) / (h * h);
  };
  put(*this, rate, acceleration);
}

void Supports::drive(double time, double shift, double dt, Vector& velocity, Vector& acceleration, Mask& given) const {
  const double h = 0.1 * dt;
  for (std::size_t m = 0; m < moved.size(); ++m) {
    const MovedNode& node = moved[m];
    const Vec3 velocities = (node.at(time + h) - node.at(time - h)) / (2 * h);
    const double late = time + shift;
    const Vec3 accelerations = (node.at(late + h) - 2 * node.at(late) + node.at(late - h)) / (h * h);
    for (int c = 0; c < 3; ++c) {
      const int k = 3 * node.node + c;
      if (moved_by[static_cast<std::size_t>(k)] != static_cast<int>(m)) continue;
      given[static_cast<std::size_t>(k)] = 1;
      velocity[k] = velocities[c];
      acceleration[k] = accelerations[c];
    }
  }
}

Supports make_supports(const Step& step, const Numbering& numbering, const Vector& u) {
  const std::size_t size = static_cast<std::size_t>(3 * numbering.nodes());
  Supports supports{pressure_mask(numbering, false), u, u, Mask(size, 0), {}, std::vector<int>(size, -1), {}};
  for (const Prescribed& condition : step.prescribed)
    for (std::size_t i = 0; i < condition.nodes.size(); ++i) {
      const int node = numbering.number_of[static_cast<std::size_t>(condition.nodes[i])];
      if (node < 0) continue;
      const bool follows = condition.function || condition.factor;
      const Vec3 value = condition.function             ? Vec3::Zero()
                         : condition.values.size() == 1 ? condition.values.front()
                                                        : condition.values[i];
      if (follows)
        supports.moved.push_back({node, numbering.mesh->points.row(condition.nodes[i]).transpose(), value,
                                  condition.function, condition.factor});
      for (int c = 0; c < 3; ++c) {
        if (!condition.components[c]) continue;
        const std::size_t k = static_cast<std::size_t>(3 * node + c);
        supports.fixed[k] = 1;
        supports.end[3 * node + c] = value[c];
        supports.ramped[k] = condition.ramp == Ramp::linear && !follows;
        supports.moved_by[k] = follows ? static_cast<int>(supports.moved.size()) - 1 : -1;
      }
    }
  for (int node = 0; node < numbering.nodes(); ++node)
    for (int c = numbering.components; c < 3; ++c) {
      const std::size_t k = static_cast<std::size_t>(3 * node + c);
      supports.fixed[k] = 1;
      supports.start[3 * node + c] = supports.end[3 * node + c] = 0;
      supports.ramped[k] = 0;
      supports.moved_by[k] = -1;
    }
  Mask moves(size, 0);
  Vector first = supports.end;
  for (std::size_t k = 0; k < size; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (supports.ramped[k]) first[i] = supports.start[i];
    if (!supports.fixed[k]) continue;
    moves[k] = supports.moved_by[k] >= 0 ? 2 : supports.end[i] != 0 || first[i] != 0;
  }
  supports.slides = make_slides(step, numbering, {supports.fixed, moves, first, supports.end});
  return supports;
}

}  // namespace msml::fe
