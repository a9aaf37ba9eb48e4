// SPDX-License-Identifier: GPL-3.0-or-later
// Relaxation series of eight elements side by side.
#pragma once
#include <span>
#include <vector>

#include "solver/materials/lanes.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// One term of the series and what a step of dt makes of it, with x = dt / tau.
struct PronyTerm {
  Lanes g, tau;
  Lanes decay;  ///< exp(-x)
  Lanes share;  ///< (1 - exp(-x)) / x
};

/// The series of eight points (see Prony and PronyHistory).
class PronySeries {
 public:
  /// Lane k has series[k], all with as many terms; the last fills the lanes that are left.
  explicit PronySeries(std::span<const Prony> series);

  /// Sets the step that follows.
  void begin_step(double dt);
  /// `part`, h_i at the start of the step, becomes that of its end, where the elastic quantity has grown by `grown`.
  void advance(std::size_t i, const Lanes& grown, Lanes& part) const {
    const PronyTerm& term = terms_[i];
    part = term.decay * part + term.g * term.share * grown;
  }
  /// What stays fixed of term i in the step: exp(-x) h_i - g share S_e,old.
  Lanes fixed(std::size_t i, const Lanes& part, const Lanes& elastic) const {
    const PronyTerm& term = terms_[i];
    return term.decay * part - term.g * term.share * elastic;
  }
  const std::vector<PronyTerm>& terms() const { return terms_; }
  const Lanes& scale() const { return scale_; }    ///< of the law to the instantaneous one
  const Lanes& rest() const { return rest_; }      ///< g_inf = 1 - sum_i g_i
  const Lanes& factor() const { return factor_; }  ///< of the elastic quantity in this step, scale included
  std::size_t bytes() const { return sizeof *this + terms_.size() * sizeof(PronyTerm); }

 private:
  std::vector<PronyTerm> terms_;
  Lanes scale_, rest_, factor_;
};

/// The series of up to eight elements (cell ids) of a region: one for all quadrature points, or where they differ from
/// place to place one for each, at the reference positions `places[q]` of point q in each element.
std::vector<PronySeries> series_of(const Region& region, std::span<const int> elements,
                                   std::span<const std::vector<Vec3>> places);

}  // namespace msml::fe
