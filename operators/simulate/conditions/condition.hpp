// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints and loads: what a tag of category "constraint" builds, and what their descriptions share.
#pragma once
#include <functional>
#include <variant>
#include <vector>

#include "operators/simulate/body.hpp"
#include "operators/simulate/selection.hpp"

namespace msml::simulation {

/// What acts on a body in the steps that list it.
struct Condition {
  std::variant<fe::Prescribed, fe::NodalForce, fe::FaceLoad> what;
  bool lasting = false;  ///< a displacement that holds in later steps too, where they say nothing of its nodes
};

/// Builds the condition on a body. Throws Error at the tag's place where its index set or its numbers do not fit.
using ConditionBuilder = std::function<Condition(const Body&, Reporter&)>;
using ConditionFactory = Factory<ConditionBuilder>;

/// One factory per available tag.
ConditionFactory fixed_constraint();
ConditionFactory displacement_constraint();
ConditionFactory force_constraint();
ConditionFactory surface_pressure();
ConditionFactory surface_pressure_on_mesh();
ConditionFactory surface_traction();

/// All of the above.
std::vector<ConditionFactory> conditions();

/// Attributes that every condition has.
struct CommonKeys {
  Key<IndexSet> indices;
  Key<std::string> for_step;
};
/// Adds `indices` (meaning nodes where the scene lists plain numbers, unless `indexes` says otherwise) and `forStep`.
CommonKeys add_common(Description& description, const std::string& doc, Indexed indexes = Indexed::nodes);

/// Adds `components`, the axes that a prescribed displacement holds; absent = all three.
Key<std::string> add_components(Description& description);
/// Sets prescribed.components from the attribute. Throws Error for anything but a list of x, y and z.
void read_components(const Record& record, Key<std::string> components, fe::Prescribed& prescribed);

/// The label of the tag, or the tag itself.
std::string label(const Record& record);

/// Three numbers for all, or three for each listed node: the values for selection.nodes. `attribute` names the numbers
/// in the message.
std::vector<Vec3> per_node(const Record& record, const std::vector<double>& numbers, const NodeSelection& selection,
                           const std::string& attribute);

/// A load on faces from one number, one per listed face, or three as a traction vector. `follower` is for pressures.
fe::FaceLoad face_load(const Record& record, const std::vector<double>& numbers, const FaceSelection& selection,
                       const std::string& attribute, bool follower);

/// The follower attribute, whose default depends on the law.
bool follows(const Record& record, Key<bool> follower, const std::vector<double>& pressure, const Body& body);

}  // namespace msml::simulation
