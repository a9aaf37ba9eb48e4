// SPDX-License-Identifier: GPL-3.0-or-later
// The laws at the quadrature points of elements: a region's own, or one that differs from place to place.
#pragma once
#include <span>
#include <vector>

#include "solver/materials/law.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// The laws of eight elements side by side: one for all quadrature points, or one for each.
struct BatchLaws {
  std::vector<std::shared_ptr<const Law>> laws;

  /// As Law::evaluate; point i belongs to laws[i] where there are several.
  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const {
    if (laws.size() == 1) return laws.front()->evaluate(want, gradients, responses);
    for (std::size_t q = 0; q < laws.size(); ++q)
      laws[q]->evaluate(want, gradients.subspan(q, 1), responses.subspan(q, 1));
  }
  const Law* only() const { return laws.size() == 1 ? laws.front().get() : nullptr; }  ///< null where there are several
  std::size_t bytes() const { return laws.size() * sizeof(laws[0]); }                  ///< of the list, not of the laws
  /// As Law::complete.
  void complete(std::size_t point, Gradients& gradient) const {
    laws[laws.size() == 1 ? 0 : point]->complete({&gradient, 1});
  }
};

/// The laws of up to eight elements of a region, lane k for element k. `places[q]` holds the reference positions of
/// quadrature point q in each of them.
BatchLaws laws_of(const Region& region, std::span<const int> elements, std::span<const std::vector<Vec3>> places);

/// The same; triangles in plane stress get the law with P_33 = 0.
BatchLaws laws_of(const Model& model, const Region& region, std::span<const int> elements,
                  std::span<const std::vector<Vec3>> places);

/// The law of one element with lane k for its quadrature point k at places[k], as measures of results need it.
std::shared_ptr<const Law> law_of_points(const Model& model, const Region& region, int element,
                                         std::span<const Vec3> places);

}  // namespace msml::fe
