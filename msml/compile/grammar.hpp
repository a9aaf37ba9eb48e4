// SPDX-License-Identifier: GPL-3.0-or-later
// The tags that hold a scene together: msml, variables, scene, object, region, workflow, environment, …
#pragma once
#include "msml/core/registry.hpp"

namespace msml {

/// Adds the structural tags. What stands in them (materials, constraints, operators, …) comes from elsewhere.
void add_grammar(Registry& registry);

/// Keys of the structural tags that the compiler itself reads.
struct VariableKeys {
  Key<std::string> name, value, logical, physical, role;
};
/// The description of <var> and its keys, always the same.
Description describe_variable(VariableKeys& keys);

struct EnvironmentKeys {
  Key<std::string> units;
};
/// The description of <environment> and its keys, always the same.
Description describe_environment(EnvironmentKeys& keys);

/// `when` may stand on any tag: `when="${kind} = tet10"`. See choose_tags.
constexpr const char* when_attribute = "when";

/// Attributes that old scenes carry without meaning: accepted with a note in verbose mode. `tag` is where it stands.
bool is_legacy_attribute(const std::string& tag, const std::string& attribute);

}  // namespace msml
