// SPDX-License-Identifier: GPL-3.0-or-later
// Factors of a time step of the relaxation series.
#include "solver/elements/prony_series.hpp"

#include <algorithm>
#include <cmath>

namespace msml::fe {

PronySeries::PronySeries(std::span<const Prony> series) : scale_(lanes_of(1)), rest_(lanes_of(1)) {
  terms_.resize(series.front().g.size());
  for (int lane = 0; lane < lanes; ++lane) {
    const Prony& own = series[std::min(static_cast<std::size_t>(lane), series.size() - 1)];
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      terms_[i].g[lane] = own.g[i];
      terms_[i].tau[lane] = own.tau[i];
      rest_[lane] -= own.g[i];
    }
    if (own.long_term) scale_[lane] = 1 / rest_[lane];
  }
  begin_step(0);
}

void PronySeries::begin_step(double dt) {
  factor_ = lanes_of(1);
  for (PronyTerm& term : terms_) {
    for (int lane = 0; lane < lanes; ++lane) {
      const bool same = lane > 0 && term.tau[lane] == term.tau[lane - 1];
      const double x = dt / term.tau[lane];
      term.decay[lane] = same ? term.decay[lane - 1] : std::exp(-x);
      term.share[lane] = same ? term.share[lane - 1] : x > 0 ? -std::expm1(-x) / x : 1;
    }
    factor_ += term.g * (term.share - 1.0);
  }
  factor_ *= scale_;
}

std::vector<PronySeries> series_of(const Region& region, std::span<const int> elements,
                                   std::span<const std::vector<Vec3>> places) {
  if (!region.prony_at) return {PronySeries({&region.prony, 1})};
  std::vector<PronySeries> all;
  for (const std::vector<Vec3>& at : places) {
    std::vector<Prony> own;
    for (std::size_t k = 0; k < at.size(); ++k)
      own.push_back(region.prony_at(elements[std::min(k, elements.size() - 1)], at[k]));
    all.emplace_back(own);
  }
  return all;
}

}  // namespace msml::fe
