// SPDX-License-Identifier: GPL-3.0-or-later
// Laws taken apart for elements that treat the volume change apart.
#pragma once
#include <span>

#include "solver/materials/law.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// The law of eight elements as rest(F) + modulus/2 g(F)^2.
struct BatchSplit {
  std::shared_ptr<const Law> rest, constraint;
  Lanes modulus;     ///< stress; infinite if incompressible
  Lanes compliance;  ///< 1 / modulus
};

/// The laws of up to eight elements of a region, lane k for element k. Each has passed check_law.
BatchSplit split_of(const Region& region, std::span<const int> elements);

}  // namespace msml::fe
