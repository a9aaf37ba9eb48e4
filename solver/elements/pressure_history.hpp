// SPDX-License-Identifier: GPL-3.0-or-later
// How the pressures of mixed elements relax.
#pragma once
#include <vector>

#include "solver/elements/assembly.hpp"
#include "solver/elements/prony_series.hpp"

namespace msml::fe {

/// The additional nodes of viscoelastic regions: the pressure that acts is the convolution of G(t) with the rate of the
/// elastic one, which is the unknown (see MixedElements).
class PressureHistory {
 public:
  PressureHistory(const Model& model, const Numbering& numbering);
  void begin_step(double dt);
  void end_step(const Vector& u);
  /// See Elements::acting.
  Vector acting(const Vector& u) const;
  std::size_t bytes() const;

 private:
  /// Up to eight nodes of one region.
  struct Nodes {
    int count = 0;
    int node[lanes];
    PronySeries series;
    Lanes elastic = {}, relaxed = {};
    std::vector<Lanes> parts;
  };
  std::vector<Nodes> nodes_;
};

}  // namespace msml::fe
