// SPDX-License-Identifier: GPL-3.0-or-later
// Takes laws apart.
#include "solver/elements/split_laws.hpp"

namespace msml::fe {

BatchSplit split_of(const Region& region, std::span<const int> elements) {
  const Split split = (region.local_law ? region.local_law(elements) : region.law)->split().value();
  BatchSplit batch{split.rest, split.constraint, lanes_of(split.modulus), {}};
  if (region.local_law)
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t e = std::min(static_cast<std::size_t>(lane), elements.size() - 1);
      batch.modulus[lane] = region.local_law(elements.subspan(e, 1))->split().value().modulus;
    }
  batch.compliance = 1 / batch.modulus;
  return batch;
}

}  // namespace msml::fe
