// SPDX-License-Identifier: GPL-3.0-or-later
// The fields that an output may ask for.
#pragma once
#include <string>
#include <vector>

namespace msml::simulation {

/// One field of a state.
struct FieldFacts {
  std::string name;
  int components = 1;
  bool nodal = false;  ///< given at nodes; otherwise at elements
  std::string doc;     ///< a phrase
};

/// All fields, in the order of the help.
const std::vector<FieldFacts>& all_fields();
/// Their names.
const std::vector<std::string>& field_names();
/// The facts of a field in a simulation with or without the mixed formulation, where the pressure is an unknown of
/// nodes; throws an internal Error for another name.
FieldFacts facts_of(const std::string& field, bool mixed);
/// Names of the components: "" of a number; x y z; xx yy zz xy yz xz; xx xy xz yx yy yz zx zy zz; 1 2 3 (principal).
std::vector<std::string> component_names(const FieldFacts& facts);

}  // namespace msml::simulation
