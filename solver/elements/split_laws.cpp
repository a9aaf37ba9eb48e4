// SPDX-License-Identifier: GPL-3.0-or-later
// Takes laws apart.
#include "solver/elements/split_laws.hpp"

#include "solver/elements/region_laws.hpp"

namespace msml::fe {

BatchSplit::BatchSplit(const Region& region, std::span<const int> elements, std::span<const std::vector<Vec3>> places) {
  for (const auto& law : laws_of(region, elements, places).laws) {
    const Split split = law->split().value();
    points_.push_back({split.rest, split.constraint, split.modulus, 1 / split.modulus});
  }
}

void BatchSplit::evaluate_rest(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const {
  if (points_.size() == 1) return points_.front().rest->evaluate(want, gradients, responses);
  for (std::size_t q = 0; q < gradients.size(); ++q)
    of(q).rest->evaluate(want, gradients.subspan(q, 1), responses.subspan(q, 1));
}

void BatchSplit::evaluate_constraint(Want want, std::span<const Gradients> gradients,
                                     std::span<Response> responses) const {
  if (points_.size() == 1) return points_.front().constraint->evaluate(want, gradients, responses);
  for (std::size_t q = 0; q < gradients.size(); ++q)
    of(q).constraint->evaluate(want, gradients.subspan(q, 1), responses.subspan(q, 1));
}

}  // namespace msml::fe
