// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of viscoelastic elements share: a step of strain that is held, with g = (0.3, 0.2), tau = (0.1, 1);
// slopes.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "solver/elements/assembly.hpp"

namespace msml::fe::testing {

/// Internal forces of the body's nodes.
inline Vector force_at(const Elements& elements, const Vector& u) {
  Vector force = Vector::Zero(u.size());
  elements.add_internal(u, Want::stress, force, nullptr);
  return force.head(3 * elements.numbering().body_nodes());
}

/// Slopes of energy and force along one unknown, by central differences of step h.
struct Slopes {
  double energy;
  Vector force;
};
inline Slopes slopes_along(const Elements& elements, const Vector& u, Eigen::Index unknown, double h) {
  Vector up = u, down = u, above = Vector::Zero(u.size()), below = above;
  up[unknown] += h, down[unknown] -= h;
  const double gained = elements.add_internal(up, Want::stress, above, nullptr).energy -
                        elements.add_internal(down, Want::stress, below, nullptr).energy;
  return {gained / (2 * h), (above - below) / (2 * h)};
}

/// S = G(t) S_e while the strain stays, whatever the time steps and the law: .79133132 at .1, .62332752 at .5,
/// .57358951 at 1, to the numbers' last digit.
inline void expect_relaxation(Elements& elements, const Vector& u, const std::string& label) {
  elements.begin_step(0);
  const Vector instant = force_at(elements, u);
  elements.end_step(u);
  const double steps[] = {0.03, 0.07, 0.25, 0.15, 0.5}, wanted[] = {0, .79133132, 0, .62332752, .57358951};
  for (std::size_t k = 0; k < 5; ++k) {
    elements.begin_step(steps[k]);
    const Vector force = force_at(elements, u);
    elements.end_step(u);
    if (wanted[k] > 0) {
      EXPECT_LT((force - wanted[k] * instant).norm(), 6e-9 * instant.norm()) << label;
    }
  }
}

}  // namespace msml::fe::testing
