// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that operators make of their attributes when a scene is compiled, and again when they run.
#pragma once
#include <functional>
#include <vector>

#include "msml/core/operator.hpp"

namespace msml::operators {

/// Throws Error where attributes exclude each other. What other tasks feed is given, but has no value while a scene is
/// compiled.
using EarlyCheck = std::function<void(const Record&)>;

/// Runs the operator with `check` before `run`, and `check` alone when a scene is compiled.
void run_checked(Operator& op, EarlyCheck check, std::function<void(Context&)> run);

/// An axis-aligned box, its faces included.
struct Bounds {
  Vec3 low, high;
  bool holds(const Vec3& p) const { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); }
};

/// The box of xmin ymin zmin xmax ymax zmax. Throws Error where a minimum is above its maximum.
Bounds bounds_of(const std::vector<double>& box);

/// A check that innerRadius is below radius.
EarlyCheck radii_in_order(Key<double> inner, Key<double> outer);

}  // namespace msml::operators
