// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of attributes.
#include "operators/early_checks.hpp"

#include <fmt/format.h>

#include <utility>

#include "msml/core/error.hpp"

namespace msml::operators {

void run_checked(Operator& op, EarlyCheck check, std::function<void(Context&)> run) {
  op.examine([check](const Examination& scene) {
    try {
      check(scene.args);
    } catch (const Error& error) {
      scene.fault(error);
    }
  });
  op.run([check = std::move(check), run = std::move(run)](Context& c) {
    check(c.args());
    run(c);
  });
}

Bounds bounds_of(const std::vector<double>& box) {
  if (box.size() != 6)
    throw Error(fmt::format("box has {} numbers; it takes 6: xmin ymin zmin xmax ymax zmax", box.size()));
  constexpr const char* axes = "xyz";
  for (std::size_t d = 0; d < 3; ++d)
    if (box[d] > box[d + 3])
      throw Error(fmt::format("box: {0}min = {1:g} is above {0}max = {2:g}; the order is xmin ymin zmin xmax ymax zmax",
                              axes[d], box[d], box[d + 3]));
  return {Vec3(box[0], box[1], box[2]), Vec3(box[3], box[4], box[5])};
}

EarlyCheck radii_in_order(Key<double> inner, Key<double> outer) {
  return [=](const Record& r) {
    if (r.has(inner) && r.has(outer) && r[inner] >= r[outer])
      throw Error(fmt::format("innerRadius = {} is not below radius = {}", r[inner], r[outer]));
  };
}

}  // namespace msml::operators
