// SPDX-License-Identifier: GPL-3.0-or-later
// What a tag stands beside, for checks of what goes with what.
#pragma once
#include <optional>

#include "solver/combinations.hpp"

namespace msml::simulation {

/// As far as it is known: before anything runs, the scene may hold faults.
struct Surroundings {
  std::optional<CellKind> kind = {};  ///< of the elements; vertex: particles
  std::optional<bool> scalar = {};    ///< the unknown is no displacement
  std::optional<bool> fibres = {};    ///< a law has fibres
  bool mixed = false;                 ///< the pressure is an unknown
  bool incompressible = false;        ///< a law is
  bool one_region = false;            ///< the body has no other
  const fe::Settings* settings = nullptr;
};

}  // namespace msml::simulation
