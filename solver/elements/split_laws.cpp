// SPDX-License-Identifier: GPL-3.0-or-later
// Takes laws apart.
#include "solver/elements/split_laws.hpp"

#include <algorithm>

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

Response joined(const Response& rest, const Response& volume, const Lanes& p, Lanes modulus, double largest,
                bool tangents) {
  Response all = rest;
  all.energy += 0.5 * p * p / modulus;
  for (int k = 0; k < 9; ++k) all.P.c[k] += p * volume.P.c[k];
  if (!tangents) return all;
  for (int lane = 0; lane < lanes; ++lane) modulus[lane] = std::min(modulus[lane], largest);
  for (int I = 0; I < 9; ++I)
    for (int J = 0; J <= I; ++J) {
      const int k = packed_at(I, J);
      all.tangent[k] += p * volume.tangent[k] + modulus * volume.P.c[I] * volume.P.c[J];
    }
  return all;
}

}  // namespace msml::fe
